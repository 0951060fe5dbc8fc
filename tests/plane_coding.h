// Numbers as planes of a format have them in memory, on the host: what host/graph/format.h and
// host/render/frame_builder.h say to kernels.
#pragma once

#include "host/graph/graph.h"
#include "kernels/shared/material.h"
#include "kernels/shared/packed.h"

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace wedge::test {

/// How a format stores elements, each of so many numbers of T.
template <class T>
struct Coding {
    std::uint32_t parts;
    /// One element, of `size` in the plane. numbers: parts, `size` apart.
    std::function<void(std::byte* plane, std::size_t size, std::size_t at, const T* numbers)> store;
    std::function<void(const std::byte* plane, std::size_t size, std::size_t at, T* numbers)> load;
};

template <class Stored>
Stored storedAt(const std::byte* plane, std::size_t at)
{
    Stored out;
    std::memcpy(&out, plane + at * sizeof(Stored), sizeof(Stored));
    return out;
}

template <class Stored>
void storeAt(std::byte* plane, std::size_t at, Stored value)
{
    std::memcpy(plane + at * sizeof(Stored), &value, sizeof(Stored));
}

/// Numbers by themselves, each Stored as pack() makes it, part after part.
template <class T, class Stored, class Pack, class Unpack>
Coding<T> numbers(std::uint32_t parts, const Pack& pack, const Unpack& unpack)
{
    return { parts,
        [=](std::byte* plane, std::size_t size, std::size_t at, const T* from) {
            for (std::size_t k = 0; k < parts; ++k) {
                storeAt(plane, k * size + at, static_cast<Stored>(pack(from[k * size])));
            }
        },
        [=](const std::byte* plane, std::size_t size, std::size_t at, T* to) {
            for (std::size_t k = 0; k < parts; ++k) {
                to[k * size] = unpack(storedAt<Stored>(plane, k * size + at));
            }
        } };
}

template <class T>
Coding<T> plain(std::uint32_t parts)
{
    const auto same = [](T v) { return v; };
    return numbers<T, T>(parts, same, same);
}

/// Vectors in so many words each; several lie one after the other.
template <class Pack, class Unpack>
Coding<float> vectorsInWords(std::uint32_t vectors, const Pack& pack, const Unpack& unpack)
{
    return { 3 * vectors,
        [=](std::byte* plane, std::size_t size, std::size_t at, const float* from) {
            for (std::size_t k = 0; k < vectors; ++k) {
                const float* v = from + 3 * k * size;
                storeAt<std::uint32_t>(plane, k * size + at, pack(shared::vec3(v[0], v[size], v[2 * size])));
            }
        },
        [=](const std::byte* plane, std::size_t size, std::size_t at, float* to) {
            for (std::size_t k = 0; k < vectors; ++k) {
                const shared::Vec3 v = unpack(storedAt<std::uint32_t>(plane, k * size + at));
                float* out = to + 3 * k * size;
                out[0] = v.x, out[size] = v.y, out[2 * size] = v.z;
            }
        } };
}

/// A word of each colour, then half a word of each.
inline Coding<float> colours()
{
    return { 3,
        [](std::byte* plane, std::size_t size, std::size_t at, const float* v) {
            const shared::PackedColour c = shared::packColour(shared::vec3(v[0], v[size], v[2 * size]));
            storeAt<std::uint32_t>(plane, at, c.low);
            storeAt(plane, 2 * size + at, static_cast<std::uint16_t>(c.high));
        },
        [](const std::byte* plane, std::size_t size, std::size_t at, float* out) {
            const shared::Vec3 v = shared::unpackColour(
                { storedAt<std::uint32_t>(plane, at), storedAt<std::uint16_t>(plane, 2 * size + at) });
            out[0] = v.x, out[size] = v.y, out[2 * size] = v.z;
        } };
}

inline std::optional<Coding<float>> codingOf(const graph::Format& format, float)
{
    const std::string_view name = format.name;
    if (name.starts_with("float")) {
        return plain<float>(format.bytes / 4);
    }
    if (name.starts_with("short") || name == "shares") {
        return numbers<float, std::uint16_t>(format.bytes / 2, shared::packShort, shared::unpackShort);
    }
    if (name == "colour48") {
        return colours();
    }
    if (name == "fraction32") {
        return vectorsInWords(1, shared::packFraction, shared::unpackFraction);
    }
    if (name == "range16") { // the end that is nearer to 0, or 0 between both
        return Coding<float> { 2,
            [](std::byte* plane, std::size_t size, std::size_t at, const float* v) {
                const float low = v[0], high = v[size];
                storeAt(plane, at, static_cast<std::uint16_t>(shared::packShort(low > 0 ? low : high < 0 ? high : 0)));
            },
            [](const std::byte* plane, std::size_t size, std::size_t at, float* out) {
                out[0] = out[size] = shared::unpackShort(storedAt<std::uint16_t>(plane, at));
            } };
    }
    if (name == "reflectors32") { // the least and the sum, not the largest between
        return Coding<float> { 3,
            [](std::byte* plane, std::size_t size, std::size_t at, const float* v) {
                storeAt(plane, at, static_cast<std::uint16_t>(shared::packShort(v[0])));
                storeAt(plane, size + at, static_cast<std::uint16_t>(shared::packShort(v[2 * size])));
            },
            [](const std::byte* plane, std::size_t size, std::size_t at, float* out) {
                out[0] = shared::unpackShort(storedAt<std::uint16_t>(plane, at));
                out[size] = 0;
                out[2 * size] = shared::unpackShort(storedAt<std::uint16_t>(plane, size + at));
            } };
    }
    if (name == "normal192") {
        return plain<float>(6);
    }
    if (name == "normal32" || name == "normal64") {
        return vectorsInWords(format.bytes / 4, shared::packNormal, shared::unpackNormal);
    }
    return std::nullopt;
}

inline std::optional<Coding<std::uint32_t>> codingOf(const graph::Format& format, std::uint32_t)
{
    const auto same = [](std::uint32_t v) { return v; };
    if (format.name == "uint1" || format.name == "gloss32") {
        return plain<std::uint32_t>(1);
    }
    if (format.name == "ushort1") {
        return numbers<std::uint32_t, std::uint16_t>(1, same, same);
    }
    if (format.name == "bins") { // as they are stored
        return numbers<std::uint32_t, std::uint16_t>(format.bytes / 2, same, same);
    }
    if (format.name == "gloss16") { // what unpackGloss() takes
        return numbers<std::uint32_t, std::uint16_t>(
            1, [](std::uint32_t v) { return shared::packGlossShort(shared::unpackGloss(v)); },
            [](std::uint16_t v) { return shared::packGloss(shared::unpackGlossShort(v)); });
    }
    return std::nullopt;
}

inline std::optional<Coding<std::uint64_t>> codingOf(const graph::Format& format, std::uint64_t)
{
    return format.name == "ulong1" ? std::optional(plain<std::uint64_t>(1)) : std::nullopt;
}

template <class T>
Coding<T> requireCoding(const graph::Resource& resource, const std::string& name)
{
    const auto coding = codingOf(resource.format, T {});
    if (!coding) {
        throw std::logic_error(fmt::format(
            "plane \"{}\" has the format {}, of other numbers than the test's", name, resource.format.name));
    }
    return *coding;
}

/// A plane of these numbers, part after part. name: what errors call it. Throws std::logic_error where the format has
/// numbers of another type, or the plane others in number.
template <class T>
std::vector<std::byte> encoded(const graph::Resource& resource, const std::string& name, const std::vector<T>& values)
{
    const Coding<T> coding = requireCoding<T>(resource, name);
    const auto size = static_cast<std::size_t>(resource.elements);
    if (values.size() != coding.parts * size) {
        throw std::logic_error(fmt::format(
            "plane \"{}\" has {} parts of {} elements, not {} in all", name, coding.parts, size, values.size()));
    }
    std::vector<std::byte> out(static_cast<std::size_t>(resource.bytes()));
    for (std::size_t at = 0; at < size; ++at) {
        coding.store(out.data(), size, at, values.data() + at);
    }
    return out;
}

/// And back.
template <class T>
std::vector<T> decoded(const graph::Resource& resource, const std::string& name, const std::vector<std::byte>& contents)
{
    const Coding<T> coding = requireCoding<T>(resource, name);
    const auto size = static_cast<std::size_t>(resource.elements);
    std::vector<T> out(coding.parts * size);
    for (std::size_t at = 0; at < size; ++at) {
        coding.load(contents.data(), size, at, out.data() + at);
    }
    return out;
}

/// Numbers of any type that a plane's format has, for comparing them.
inline std::vector<double> anyNumbers(
    const graph::Resource& resource, const std::string& name, const std::vector<std::byte>& contents)
{
    const auto widened = [](const auto& numbers) { return std::vector<double>(numbers.begin(), numbers.end()); };
    if (codingOf(resource.format, 0.0f)) {
        return widened(decoded<float>(resource, name, contents));
    }
    if (codingOf(resource.format, std::uint32_t { 0 })) {
        return widened(decoded<std::uint32_t>(resource, name, contents));
    }
    return widened(decoded<std::uint64_t>(resource, name, contents));
}

} // namespace wedge::test
