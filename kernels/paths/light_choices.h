// One light for each path of a packet at its vertex, and a sample of it.
#ifndef WEDGE_LIGHT_CHOICES_H
#define WEDGE_LIGHT_CHOICES_H

#include "light/scene_light.h"
#include "paths/path_vertices.h"

/// See LightChoice.
typedef struct {
    VecLanes ray, direction, irradiance;
    float pdf[WEDGE_PACKET_SIZE], end[WEDGE_PACKET_SIZE];
} LightChoices;

WEDGE_INLINE void keepChoice(LightChoices* out, uint lane, LightChoice c)
{
    setLaneVec(&out->ray, lane, c.ray);
    setLaneVec(&out->direction, lane, c.direction);
    setLaneVec(&out->irradiance, lane, c.irradiance);
    out->pdf[lane] = c.pdf;
    out->end[lane] = c.end;
}

/// What sampleAreaLight() asks of each lane's light.
typedef struct {
    VecLanes centre, halfU, halfV, normal, power;
    float cut[WEDGE_PACKET_SIZE], erfCut[WEDGE_PACKET_SIZE], profileArea[WEDGE_PACKET_SIZE], pick[WEDGE_PACKET_SIZE];
    float lift[WEDGE_PACKET_SIZE];
    uint profile[WEDGE_PACKET_SIZE], twoSided[WEDGE_PACKET_SIZE];
} AreaLightLanes;

WEDGE_INLINE void fetchLight(AreaLightLanes* out, uint lane, __global const AreaLight* light)
{
    setLaneVec(&out->centre, lane, light->centre);
    setLaneVec(&out->halfU, lane, light->halfU);
    setLaneVec(&out->halfV, lane, light->halfV);
    setLaneVec(&out->normal, lane, light->normal);
    setLaneVec(&out->power, lane, light->power);
    out->cut[lane] = light->cut;
    out->erfCut[lane] = light->erfCut;
    out->profileArea[lane] = light->profileArea;
    out->pick[lane] = light->pick;
    out->profile[lane] = light->profile;
    out->twoSided[lane] = light->twoSided;
    out->lift[lane] = light->lift;
}

WEDGE_INLINE AreaLight laneLight(const AreaLightLanes* l, uint lane)
{
    AreaLight light;
    light.centre = laneVec(&l->centre, lane);
    light.halfU = laneVec(&l->halfU, lane);
    light.halfV = laneVec(&l->halfV, lane);
    light.normal = laneVec(&l->normal, lane);
    light.power = laneVec(&l->power, lane);
    light.cut = l->cut[lane];
    light.erfCut = l->erfCut[lane];
    light.profileArea = l->profileArea[lane];
    light.pick = l->pick[lane];
    light.profile = l->profile[lane];
    light.twoSided = l->twoSided[lane];
    light.lift = l->lift[lane];
    return light;
}

/// Samples of the lanes that chose an area light; others' bring nothing.
WEDGE_FN void sampleAreaLights(
    LightData lights, const uint* chosen, const VertexPacket* at, const float* u, const float* v, LightChoices* out)
{
    AreaLightLanes own;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        fetchLight(&own, lane, lights.area + (chosen[lane] < lights.areaCount ? chosen[lane] : 0u));
    }
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        LightChoice c = sampleAreaLight(
            laneLight(&own, lane), laneVec(&at->origin, lane), laneVec(&at->normal, lane), vec2(u[lane], v[lane]));
        const bool used = chosen[lane] < lights.areaCount;
        c.irradiance = vecChoose(used, c.irradiance, vec3(0.0f, 0.0f, 0.0f));
        c.pdf = used ? c.pdf : 0.0f;
        keepChoice(out, lane, c);
    }
}

/// Samples of the lanes that chose another light.
WEDGE_FN void sampleOtherLights(LightData lights, const uint* chosen, const VertexPacket* at, const RayPacket* rays,
    const float* u, const float* v, LightChoices* out)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        if (chosen[lane] < lights.areaCount || chosen[lane] == WEDGE_NO_LIGHT) {
            continue;
        }
        const uint i = chosen[lane] - lights.areaCount;
        const Vec3 origin = laneVec(&at->origin, lane), normal = laneVec(&at->normal, lane);
        if (i < lights.deltaCount) {
            keepChoice(out, lane, sampleDeltaLight(lights.delta + i, lights.sceneDiameter, origin, normal));
        } else if (WEDGE_ENVIRONMENT_MAP != 0 && i > lights.deltaCount) {
            keepChoice(out, lane, sampleBeyond(lights.beyond, normal, vec2(u[lane], v[lane])));
        } else {
            keepChoice(out, lane,
                sampleEmitterLight(lights.emitters, origin, normal, vec2(u[lane], v[lane]), timeOf(rays, lane)));
        }
    }
}

WEDGE_FN void chooseLights(LightData lights, SampleParams params, const PathPacket* paths, uint vertex,
    const VertexPacket* at, const RayPacket* rays, LightChoices* out)
{
    float pick[WEDGE_PACKET_SIZE], unused[WEDGE_PACKET_SIZE], u[WEDGE_PACKET_SIZE], v[WEDGE_PACKET_SIZE];
    pathPairs(params, paths, at->live, vertex, WEDGE_DIMENSION_CHOICE, pick, unused);
    pathPairs(params, paths, at->live, vertex, WEDGE_DIMENSION_LIGHT, u, v);
    uint chosen[WEDGE_PACKET_SIZE];
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        chosen[lane] = at->live[lane] != 0u ? pickLight(lights, pick[lane]) : WEDGE_NO_LIGHT;
    }
    if (lights.areaCount > 0u) {
        sampleAreaLights(lights, chosen, at, u, v, out);
    } else {
        LightChoice none;
        none.ray = none.direction = none.irradiance = vec3(0.0f, 0.0f, 0.0f);
        none.pdf = none.end = 0.0f;
        for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
            keepChoice(out, lane, none);
        }
    }
    if (WEDGE_ENVIRONMENT_MAP != 0 || lights.deltaCount + lights.emitters.count > 0u) {
        sampleOtherLights(lights, chosen, at, rays, u, v, out);
    }
}

#endif
