// Lists of receivers: which pixels take how many primary samples, which samples of lights and paths each of those
// takes.
//
// A wave has the receivers of consecutive tiles, pixel by pixel, so that the receivers of a packet are neighbours or
// samples of one pixel, and a pixel's are all in one wave.
#include "core/receivers.h"
#include "shared/wave.h"

/// Primary samples that a pixel takes now.
WEDGE_FN uint newSamples(WaveParams wave, uint taken, uint wanted)
{
    const uint last = wantedSamples(wave, wanted);
    return last > taken ? last - taken : 0u;
}

/// Receivers of each tile.
/// in   taken, wanted: primary samples of each pixel
/// out  tileReceivers: one a tile, in the order of tiles
#include "pass/countReceivers.h"
#ifdef PASS_countReceivers
__kernel void countReceivers(PARAMETERS)
{
    const uint slot = get_global_id(0);
    if (slot >= frame.tileCount) {
        return;
    }
    uint sum = 0u;
    for (uint k = 0u; k < WEDGE_TILE_PIXELS; ++k) {
        uint x, y;
        if (slotPixel(frame, slot, k, &x, &y)) {
            const uint i = pixelIndex(x, y, frame.stride);
            sum += newSamples(wave, taken[i], wanted[i]);
        }
    }
    tileReceivers[slot] = sum;
}
#endif

/// New samples of a tile's pixels where none takes more than `most`; no more than 2^32 / WEDGE_TILE_PIXELS.
WEDGE_FN uint newSamplesOfTile(
    FrameParams frame, uint slot, uint most, __global const uint* restrict taken, __global const uint* restrict wanted)
{
    uint sum = 0u;
    for (uint k = 0u; k < WEDGE_TILE_PIXELS; ++k) {
        uint x, y;
        if (slotPixel(frame, slot, k, &x, &y)) {
            const uint i = pixelIndex(x, y, frame.stride);
            sum += min(max(wanted[i], taken[i]) - taken[i], most);
        }
    }
    return sum;
}

/// No more new primary samples in a tile than a wave has room for: where its pixels want more, none of them takes more
/// than as many as fit in then. frame: of the whole image, whose tiles a crop's are among
#include "pass/limitTiles.h"
#ifdef PASS_limitTiles
__kernel void limitTiles(PARAMETERS)
{
    const uint slot = get_global_id(0);
    if (slot >= frame.tileCount || newSamplesOfTile(frame, slot, capacity, taken, wanted) <= capacity) {
        return;
    }
    // The greatest number that fits: `fits` does, `exceeds` does not.
    uint fits = capacity / WEDGE_TILE_PIXELS, exceeds = capacity;
    while (exceeds - fits > 1u) {
        const uint middle = (fits + exceeds) / 2u;
        if (newSamplesOfTile(frame, slot, middle, taken, wanted) <= capacity) {
            fits = middle;
        } else {
            exceeds = middle;
        }
    }
    for (uint k = 0u; k < WEDGE_TILE_PIXELS; ++k) {
        uint x, y;
        if (slotPixel(frame, slot, k, &x, &y)) {
            const uint i = pixelIndex(x, y, frame.stride);
            wanted[i] = min(wanted[i], taken[i] + fits);
        }
    }
}
#endif

/// The receivers of a wave.
/// in   taken, wanted as above; tileFirst: of each tile, where its receivers start in the wave
/// out  pixelOf: as in receivers.h; sampleOf: index of the primary sample; shareOf: which of its pixel's receivers of
///      this wave it is, and, in the upper 16 bits, how many they are; pixelFirst, pixelCount: of each pixel of the
///      wave's tiles, its receivers
#include "pass/listReceivers.h"
#ifdef PASS_listReceivers
__kernel void listReceivers(PARAMETERS)
{
    const uint tile = get_global_id(0);
    if (tile >= wave.tiles) {
        return;
    }
    uint at = tileFirst[wave.firstTile + tile];
    for (uint k = 0u; k < WEDGE_TILE_PIXELS; ++k) {
        uint x, y;
        const bool inside = slotPixel(frame, wave.firstTile + tile, k, &x, &y);
        const uint i = inside ? pixelIndex(x, y, frame.stride) : 0u;
        const uint count = inside ? newSamples(wave, taken[i], wanted[i]) : 0u;
        pixelFirst[tile * WEDGE_TILE_PIXELS + k] = at;
        pixelCount[tile * WEDGE_TILE_PIXELS + k] = count;
        for (uint j = 0u; j < count; ++j) {
            pixelOf[at + j] = x | y << 16;
            sampleOf[at + j] = taken[i] + j;
            shareOf[at + j] = j | count << 16;
        }
        at += count;
    }
}
#endif

/// The samples of one term that each receiver takes: those that its pixel takes now, shared out evenly.
/// in   taken, wanted: the pixels' samples of the term
/// out  first, last: of each receiver, half open; sums, extremes (planes of the wave): 0
#include "pass/shareSamples.h"
#ifdef PASS_shareSamples
__kernel void shareSamples(PARAMETERS)
{
    const uint receiver = get_global_id(0);
    if (receiver >= wave.receivers) {
        return;
    }
    const uint i = pixelIndex(pixelOf[receiver] & 0xffffu, pixelOf[receiver] >> 16, frame.stride);
    const uint index = shareOf[receiver] & 0xffffu, count = shareOf[receiver] >> 16;
    const uint total = newSamples(wave, taken[i], wanted[i]);
    first[receiver] = taken[i] + sharedSamples(index, count, total);
    last[receiver] = taken[i] + sharedSamples(index + 1u, count, total);
    for (uint plane = 0u; plane < sumPlanes; ++plane) {
        sums[plane * wave.planeSize + receiver] = 0.0f;
    }
    for (uint plane = 0u; plane < extremePlanes; ++plane) {
        extremes[plane * wave.planeSize + receiver] = 0.0f;
    }
}
#endif
