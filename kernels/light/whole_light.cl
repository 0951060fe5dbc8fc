// All of a map's light, as if nothing were hidden: what shadow_lights.cl takes shadows from. Without reflectances, as
// sums of lights are.
#include "light/light_packet.h"
#include "light/light_tree.h"
#include "light/unshadowed_environment.h"

/// Levels of the map's averages: chosen under two probes, where 512 directions of a lobe show which they are.
#define WEDGE_WHOLE_COARSER 1.5f

/// What lobes reflect of the map if nothing hides it, over their specular reflectance.
/// in      rings: of unshadowedLobe(); specular: 3 planes; the map, receivers
/// in out  whole: 3 planes, set where something is reflected
#include "pass/wholeLobes.h"
#ifdef PASS_wholeLobes
__kernel void wholeLobes(PARAMETERS)
{
    ReceiverPacket receivers;
    const ReceiverData data = WEDGE_RECEIVER_ARGUMENTS;
    loadReceivers(frame, 0u, firstGroup, data, &receivers);
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const uint i = receivers.pixel[lane];
        if (i != WEDGE_NO_PIXEL && luminance(loadVec(specular, frame.planeSize, i)) > 0.0f) {
            const Vec3 n = vec3(receivers.normalX[lane], receivers.normalY[lane], receivers.normalZ[lane]);
            const Vec3 v = laneView(&receivers, lane);
            storeVec(whole, frame.planeSize, i,
                unshadowedLobe(
                    environment[0], environmentTable, n, v, unpackGloss(gloss[i]), rings, WEDGE_WHOLE_COARSER));
        }
    }
}
#endif

/// What surfaces reflect of all of the map if nothing hides it, over their reflectances.
/// in      tree: `parts` of the map, see light_tree.h; least: see lobeLight(); specular: 3 planes; receivers
/// in out  wholeMatt, whole (of lobes): 3 planes each, set where there is a surface
#include "pass/wholeLight.h"
#ifdef PASS_wholeLight
__kernel void wholeLight(PARAMETERS)
{
    ReceiverPacket receivers;
    const ReceiverData data = WEDGE_RECEIVER_ARGUMENTS;
    loadReceivers(frame, 0u, firstGroup, data, &receivers);
    uint shaded[WEDGE_PACKET_SIZE];
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        shaded[lane] = receivers.pixel[lane] != WEDGE_NO_PIXEL ? 1u : 0u;
    }
    MapLanes sum;
    clearLanes(&sum);
    mattLight(tree, parts, &receivers, shaded, &sum);
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const uint i = receivers.pixel[lane];
        if (i != WEDGE_NO_PIXEL) {
            storeVec(wholeMatt, frame.planeSize, i, vecScale(lightOf(&sum, lane), WEDGE_INV_PI));
        }
    }
#ifdef WEDGE_SPECULAR
    uint reflects[WEDGE_PACKET_SIZE];
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const uint i = receivers.pixel[lane];
        reflects[lane] = i != WEDGE_NO_PIXEL && luminance(loadVec(specular, frame.planeSize, i)) > 0.0f ? 1u : 0u;
    }
    clearLanes(&sum);
    lobeLight(tree, parts, &receivers, reflects, least, &sum);
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        const uint i = receivers.pixel[lane];
        if (i != WEDGE_NO_PIXEL) {
            storeVec(whole, frame.planeSize, i, lightOf(&sum, lane));
        }
    }
#else
    (void)least;
    (void)specular;
#endif
}
#endif
