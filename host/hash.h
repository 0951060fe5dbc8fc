#pragma once

#include <cstddef>
#include <cstdint>

namespace wedge {

/// 64-bit FNV-1a (Fowler, Noll, Vo) of what is added, byte by byte or a number at a time: it tells apart what differs
/// by chance, not what somebody makes alike.
class Hash {
public:
    void add(std::uint64_t number) { value_ = (value_ ^ number) * 0x100000001b3u; }

    void addBytes(const void* data, std::size_t count)
    {
        const auto* byte = static_cast<const unsigned char*>(data);
        for (std::size_t i = 0; i < count; ++i) {
            add(byte[i]);
        }
    }

    std::uint64_t value() const { return value_; }

private:
    std::uint64_t value_ = 0xcbf29ce484222325u;
};

/// Of a container of bytes.
template <class Bytes>
std::uint64_t hashOf(const Bytes& bytes)
{
    static_assert(sizeof(bytes[0]) == 1);
    Hash hash;
    hash.addBytes(bytes.data(), bytes.size());
    return hash.value();
}

} // namespace wedge
