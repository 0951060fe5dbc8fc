// Parameters of the passes that trace paths, and of the analysis of what they found.
#ifndef WEDGE_SHARED_PATH_H
#define WEDGE_SHARED_PATH_H

#include "material.h"
#include "vec.h"

/// What a term holds.
#define WEDGE_COMPONENT_DIFFUSE 0u ///< radiance that arrives, cosine-weighted mean
#define WEDGE_COMPONENT_GLOSSY 1u ///< radiance that the specular lobe reflects, without its colour
#define WEDGE_COMPONENT_AMBIENT 2u ///< fraction of the cosine-weighted hemisphere in which something is near
#define WEDGE_COMPONENT_EMITTERS 3u ///< as diffuse, of meshes that emit alone
#define WEDGE_COMPONENT_EMITTERS_GLOSSY 4u ///< as glossy

#define WEDGE_COMPONENT_ENVIRONMENT 5u ///< as diffuse, of what is beyond the scene alone
#define WEDGE_COMPONENT_ENVIRONMENT_GLOSSY 6u ///< as glossy

#define WEDGE_IS_GLOSSY(component)                                                                                     \
    ((component) == WEDGE_COMPONENT_GLOSSY || (component) == WEDGE_COMPONENT_EMITTERS_GLOSSY                           \
        || (component) == WEDGE_COMPONENT_ENVIRONMENT_GLOSSY)
#define WEDGE_IS_OF_EMITTERS(component)                                                                                \
    ((component) == WEDGE_COMPONENT_EMITTERS || (component) == WEDGE_COMPONENT_EMITTERS_GLOSSY)
#define WEDGE_IS_OF_ENVIRONMENT(component) ((component) >= WEDGE_COMPONENT_ENVIRONMENT)

/// Pixels around one, either way, whose rays tell how near what surrounds it is.
#define WEDGE_NEARNESS_REACH 2

/// Stripes of rows that each reduce what the camera sees.
#define WEDGE_EXTENT_STRIPES 32u

WEDGE_SHARED_BEGIN

typedef struct {
    uint component; ///< WEDGE_COMPONENT_*
    uint bounces; ///< at least 1
    uint sampler; ///< WEDGE_SAMPLER_*
    uint lightSampling; ///< WEDGE_LIGHTS_*
    uint firstPass; ///< samples of a first pass with strata of its own; 0: none
    uint areaLights, deltaLights;
    float sceneDiameter; ///< metres
    float ambientDistance; ///< metres; surfaces farther away do not count for the ambient component
    uint strata; ///< as of SampleParams
    uint emitters; ///< length of their list
    float emitterShare; ///< probability that a path's vertex samples one of them and no other light
    Vec3 emittersLow, emittersHigh; ///< the box that they are in, metres
    float directedWithin; ///< metres from it within which diffuse parts follow reflected directions, too
    float environmentShare; ///< as emitterShare, of what is beyond the scene
    uint relative; ///< 1: samples of the environment are divided by unshadowedLight()
    uint skipsMirrors; ///< 1: receivers on mirrors and glass have no samples
    uint precomputed; ///< 1: directions beyond the scene are chosen among pre-computed samples
    uint occluders; ///< 1: of the environment, distances are those of what hides directions, over their cosines
    uint fractions; ///< 1: samples of the environment's lobes are fractions (path_sampling.h)
    uint
        mostMirrored; ///< mirrors and glass one after the other from which on Russian roulette ends paths of the camera
    float touching; ///< metres: faces of glass as near as this are in one place
    uint mediaCount; ///< bodies of glass that the camera is inside of
    uint media[WEDGE_MOST_MEDIA]; ///< by MaterialData::medium, from the outermost
} PathParams;

/// Distances of reflectors to widths and counts.
typedef struct {
    uint x0, y0, x1, y1; ///< the pixels to produce, half open; x0 a multiple of WEDGE_BLOCK_PIXELS
    uint width, height, stride, planeSize;
    uint component;
    float mu, alpha; ///< of (4.15) and (4.21)
    float widthScale; ///< standard deviation times bandwidth
    float extent; ///< metres; 0: what the camera sees
    float leastReflector; ///< fraction of the extent that distances are clamped to
    float meanFraction; ///< of the harmonic mean distance that stands for the least one; 0: the least one itself
    uint countCap; ///< most samples a pixel may take
    float fixedWidth; ///< pixels; more than 0: this width everywhere in place of the analysis
    uint meanOnly; ///< 1: of reflectors there is but the sum of inverse distances
    uint fractions; ///< 1: sums are those of fractions (path_sampling.h)
} ReflectorParams;

WEDGE_SHARED_END

#endif
