#pragma once

#include "bvh/host_traverse.h"
#include "kernels/shared/hit.h"

#include <cassert>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace wedge::bvh {

/// Words of a ray, and of a hit, in a packet: one array of as many lanes for each.
inline constexpr std::size_t rayWords = sizeof(Ray) / sizeof(float), hitWords = sizeof(shared::Hit) / sizeof(float);

/// Rays as RayPacket of kernels/trace/packet.h holds them, `lanes` to a packet: the same word of all its rays side by
/// side. Lanes that the last packet has over hold rays of an empty interval. times: one a ray, for programs with
/// WEDGE_MOTION; empty for those without.
inline std::vector<float> packRays(std::span<const Ray> rays, std::size_t lanes, std::span<const float> times = {})
{
    assert(times.empty() || times.size() == rays.size());
    const std::size_t packets = (rays.size() + lanes - 1) / lanes, allWords = rayWords + (times.empty() ? 0 : 1);
    std::vector<float> out(packets * lanes * allWords);
    const Ray none { { 0, 0, 0 }, 0, { 0, 0, 1 }, 0 };
    for (std::size_t i = 0; i < packets * lanes; i++) {
        float words[rayWords];
        std::memcpy(words, i < rays.size() ? &rays[i] : &none, sizeof words);
        for (std::size_t word = 0; word < rayWords; word++)
            out[(i / lanes * allWords + word) * lanes + i % lanes] = words[word];
        if (i < times.size())
            out[(i / lanes * allWords + rayWords) * lanes + i % lanes] = times[i];
    }
    return out;
}

/// The hits of the first `count` rays from PacketHits of kernels/trace/packet.h, as words.
inline std::vector<shared::Hit> unpackHits(std::span<const std::uint32_t> packets, std::size_t lanes, std::size_t count)
{
    assert(packets.size() >= (count + lanes - 1) / lanes * lanes * hitWords);
    std::vector<shared::Hit> out(count);
    for (std::size_t i = 0; i < count; i++) {
        std::uint32_t words[hitWords];
        for (std::size_t word = 0; word < hitWords; word++)
            words[word] = packets[(i / lanes * hitWords + word) * lanes + i % lanes];
        std::memcpy(&out[i], words, sizeof words);
    }
    return out;
}

} // namespace wedge::bvh
