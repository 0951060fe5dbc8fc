#pragma once

#include "host/hash.h"
#include "host/scene/scene.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace wedge::benchmark {

/// A 64-bit FNV-1a hash, grown value by value. Not against malice: it names files of a cache.
class Fingerprint {
public:
    void add(std::string_view text);

    template <class T>
    requires std::is_arithmetic_v<T>
    void add(T value) { hash_.addBytes(&value, sizeof value); }

    template <class T>
    requires std::is_arithmetic_v<T>
    void add(std::span<const T> values)
    {
        add(values.size());
        hash_.addBytes(values.data(), values.size_bytes());
    }

    /// 16 hexadecimal digits.
    std::string text() const;

private:
    Hash hash_;
};

/// All of a scene that decides what its image looks like; names and paths do not count.
void add(Fingerprint& fingerprint, const scene::Scene& scene);

} // namespace wedge::benchmark
