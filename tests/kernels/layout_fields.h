// Every field of every struct that host and device share, in the order of their offsets. STRUCT(S) comes before and
// END(S) after the fields FIELD(S, f) of each.
STRUCT(Vec3)
FIELD(Vec3, x) FIELD(Vec3, y) FIELD(Vec3, z) END(Vec3) STRUCT(Vec2) FIELD(Vec2, x) FIELD(Vec2, y) END(Vec2) STRUCT(
    Hit) FIELD(Hit, t) FIELD(Hit, u) FIELD(Hit, v) FIELD(Hit, triangle) END(Hit) STRUCT(BvhNode) FIELD(BvhNode,
    loX) FIELD(BvhNode, hiX) FIELD(BvhNode, loY) FIELD(BvhNode, hiY) FIELD(BvhNode, loZ) FIELD(BvhNode,
    hiZ) FIELD(BvhNode, child) FIELD(BvhNode, unit) FIELD(BvhNode,
    padding) END(BvhNode) STRUCT(BvhNode4) FIELD(BvhNode4, loX) FIELD(BvhNode4, hiX) FIELD(BvhNode4,
    loY) FIELD(BvhNode4, hiY) FIELD(BvhNode4, loZ) FIELD(BvhNode4, hiZ) FIELD(BvhNode4,
    child) FIELD(BvhNode4, unit) FIELD(BvhNode4, padding) END(BvhNode4) STRUCT(TriangleBlock) FIELD(TriangleBlock,
    v0x) FIELD(TriangleBlock, v0y) FIELD(TriangleBlock,
    v0z) FIELD(TriangleBlock, v1x) FIELD(TriangleBlock,
    v1y) FIELD(TriangleBlock, v1z) FIELD(TriangleBlock, v2x)
    FIELD(TriangleBlock, v2y) FIELD(
        TriangleBlock, v2z) FIELD(TriangleBlock, triangle) END(TriangleBlock) STRUCT(MovingNode) FIELD(MovingNode,
        loX) FIELD(MovingNode, hiX) FIELD(MovingNode, loY) FIELD(MovingNode, hiY) FIELD(MovingNode,
        loZ) FIELD(MovingNode, hiZ) FIELD(MovingNode, child) FIELD(MovingNode, unit) FIELD(MovingNode,
        padding) FIELD(MovingNode, moveLoX) FIELD(MovingNode, moveHiX) FIELD(MovingNode, moveLoY)
        FIELD(MovingNode, moveHiY) FIELD(MovingNode, moveLoZ) FIELD(MovingNode, moveHiZ) END(
            MovingNode) STRUCT(MovingNode4) FIELD(MovingNode4, loX) FIELD(MovingNode4, hiX) FIELD(MovingNode4,
            loY) FIELD(MovingNode4,
            hiY) FIELD(MovingNode4,
            loZ) FIELD(MovingNode4,
            hiZ) FIELD(MovingNode4,
            child) FIELD(MovingNode4, unit) FIELD(MovingNode4, padding) FIELD(MovingNode4, moveLoX) FIELD(MovingNode4,
            moveHiX) FIELD(MovingNode4,
            moveLoY) FIELD(MovingNode4,
            moveHiY) FIELD(MovingNode4,
            moveLoZ) FIELD(MovingNode4,
            moveHiZ) END(MovingNode4) STRUCT(MovingTriangleBlock) FIELD(MovingTriangleBlock,
            v0x) FIELD(MovingTriangleBlock,
            v0y) FIELD(MovingTriangleBlock,
            v0z) FIELD(MovingTriangleBlock,
            v1x) FIELD(MovingTriangleBlock,
            v1y) FIELD(MovingTriangleBlock,
            v1z) FIELD(MovingTriangleBlock,
            v2x) FIELD(MovingTriangleBlock,
            v2y) FIELD(MovingTriangleBlock,
            v2z) FIELD(MovingTriangleBlock,
            triangle) FIELD(MovingTriangleBlock,
            move0x) FIELD(MovingTriangleBlock, move0y) FIELD(MovingTriangleBlock, move0z) FIELD(MovingTriangleBlock,
            move1x) FIELD(MovingTriangleBlock, move1y) FIELD(MovingTriangleBlock, move1z) FIELD(MovingTriangleBlock,
            move2x) FIELD(MovingTriangleBlock,
            move2y) FIELD(MovingTriangleBlock, move2z) END(MovingTriangleBlock) STRUCT(FrameParams) FIELD(FrameParams,
            width) FIELD(FrameParams, height) FIELD(FrameParams,
            stride) FIELD(FrameParams, planeSize) FIELD(FrameParams,
            x0) FIELD(FrameParams, y0) FIELD(FrameParams, x1) FIELD(FrameParams,
            y1) FIELD(FrameParams, tilesX) FIELD(FrameParams,
            tileCount) FIELD(FrameParams, tileStep) FIELD(FrameParams, seed) FIELD(FrameParams,
            eye) FIELD(FrameParams,
            forward) FIELD(FrameParams,
            right) FIELD(FrameParams, down) FIELD(FrameParams, background) FIELD(FrameParams,
            receivers) END(FrameParams) STRUCT(AreaLight) FIELD(AreaLight,
            centre) FIELD(AreaLight, sigma) FIELD(AreaLight, halfU) FIELD(AreaLight,
            cut) FIELD(AreaLight, halfV) FIELD(AreaLight, erfCut) FIELD(AreaLight,
            normal) FIELD(AreaLight,
            profile) FIELD(AreaLight, power) FIELD(AreaLight, twoSided) FIELD(AreaLight, radiance) FIELD(AreaLight,
            visible) FIELD(AreaLight, profileArea) FIELD(AreaLight,
            pick) FIELD(AreaLight,
            padding) END(AreaLight) STRUCT(DeltaLight) FIELD(DeltaLight, vector) FIELD(DeltaLight,
            directional) FIELD(DeltaLight, colour) FIELD(DeltaLight,
            pick) END(DeltaLight) STRUCT(SampleParams) FIELD(SampleParams, shading) FIELD(SampleParams,
            sampler) FIELD(SampleParams, light) FIELD(SampleParams,
            firstPass) FIELD(SampleParams, lightSampling) FIELD(SampleParams,
            strata) FIELD(SampleParams,
            padding) END(SampleParams) STRUCT(FilterParams) FIELD(FilterParams,
            eye) FIELD(FilterParams, forward) FIELD(FilterParams,
            right) FIELD(FilterParams, down) FIELD(FilterParams, lightCentre) FIELD(FilterParams,
            lightNormal) FIELD(FilterParams, normalCosine) FIELD(FilterParams, cut) FIELD(FilterParams,
            oblique) FIELD(FilterParams, narrower) FIELD(FilterParams, maxRadius) FIELD(FilterParams,
            width) FIELD(FilterParams, stride) FIELD(FilterParams,
            planeSize) FIELD(FilterParams, x0) FIELD(FilterParams, y0) FIELD(FilterParams, x1) FIELD(FilterParams,
            y1) FIELD(FilterParams,
            height) FIELD(FilterParams,
            surface) END(FilterParams) STRUCT(AnalysisParams) FIELD(AnalysisParams,
            x0) FIELD(AnalysisParams, y0) FIELD(AnalysisParams,
            x1) FIELD(AnalysisParams, y1) FIELD(AnalysisParams,
            width) FIELD(AnalysisParams, height) FIELD(AnalysisParams, stride) FIELD(AnalysisParams,
            planeSize) FIELD(AnalysisParams, sigma) FIELD(AnalysisParams, lightSize) FIELD(AnalysisParams,
            k) FIELD(AnalysisParams, mu) FIELD(AnalysisParams, alpha) FIELD(AnalysisParams,
            fillRadius) FIELD(AnalysisParams, fillScale) FIELD(AnalysisParams, countCap) FIELD(AnalysisParams,
            fixedWidth) FIELD(AnalysisParams, countExponent) FIELD(AnalysisParams, varianceFloor) FIELD(AnalysisParams,
            varianceSpread) FIELD(AnalysisParams, lightCentre) FIELD(AnalysisParams,
            packed) FIELD(AnalysisParams, leastCount) END(AnalysisParams) STRUCT(PathParams) FIELD(PathParams,
            component) FIELD(PathParams, bounces) FIELD(PathParams,
            sampler) FIELD(PathParams, lightSampling) FIELD(PathParams,
            firstPass) FIELD(PathParams, areaLights) FIELD(PathParams, deltaLights) FIELD(PathParams,
            sceneDiameter) FIELD(PathParams, ambientDistance) FIELD(PathParams,
            strata) FIELD(PathParams, padding) END(PathParams) STRUCT(ReflectorParams) FIELD(ReflectorParams,
            x0) FIELD(ReflectorParams, y0) FIELD(ReflectorParams, x1) FIELD(ReflectorParams,
            y1) FIELD(ReflectorParams, width) FIELD(ReflectorParams,
            height) FIELD(ReflectorParams, stride) FIELD(ReflectorParams, planeSize) FIELD(ReflectorParams,
            component) FIELD(ReflectorParams, mu) FIELD(ReflectorParams,
            alpha) FIELD(ReflectorParams, widthScale) FIELD(ReflectorParams,
            extent) FIELD(ReflectorParams, leastReflector) FIELD(ReflectorParams, meanFraction) FIELD(ReflectorParams,
            countCap) FIELD(ReflectorParams, fixedWidth)
            FIELD(ReflectorParams, countExponent) FIELD(ReflectorParams, varianceSpread) FIELD(
                ReflectorParams, meanOnly) END(ReflectorParams) STRUCT(MaterialData) FIELD(MaterialData,
                diffuse) FIELD(MaterialData, exponent) FIELD(MaterialData, specular) FIELD(MaterialData,
                specularModel) FIELD(MaterialData, emission) FIELD(MaterialData, diffuseTexture) FIELD(MaterialData,
                specularTexture) FIELD(MaterialData, exponentTexture) FIELD(MaterialData, emissionTexture)
                FIELD(MaterialData, padding) END(MaterialData) STRUCT(TextureData) FIELD(TextureData, offset) FIELD(
                    TextureData, width) FIELD(TextureData, height) FIELD(TextureData,
                    padding) END(TextureData) STRUCT(CameraParams) FIELD(CameraParams,
                    eye) FIELD(CameraParams, apertureRadius) FIELD(CameraParams, forward) FIELD(CameraParams,
                    focusDistance) FIELD(CameraParams,
                    right) FIELD(CameraParams, gaussianAperture) FIELD(CameraParams, down) FIELD(CameraParams,
                    gaussianShutter) FIELD(CameraParams, eyeMotion) FIELD(CameraParams,
                    pixelFilter) FIELD(CameraParams, forwardMotion) FIELD(CameraParams, erfCut)
                    FIELD(CameraParams, rightMotion) FIELD(CameraParams, shutter) FIELD(CameraParams, downMotion) FIELD(
                        CameraParams, pixelStep) END(CameraParams) STRUCT(WaveParams) FIELD(WaveParams,
                        firstTile) FIELD(WaveParams, tiles) FIELD(WaveParams, receivers) FIELD(WaveParams,
                        planeSize) FIELD(WaveParams, lastSample) FIELD(WaveParams, sampler) FIELD(WaveParams,
                        firstPass) FIELD(WaveParams, published) FIELD(WaveParams, omits) FIELD(WaveParams,
                        packed) FIELD(WaveParams, oneVelocity) END(WaveParams) STRUCT(DistributedParams)
                        FIELD(DistributedParams, x0) FIELD(DistributedParams, y0) FIELD(DistributedParams,
                            x1) FIELD(DistributedParams, y1) FIELD(DistributedParams, width) FIELD(DistributedParams,
                            height) FIELD(DistributedParams, stride) FIELD(DistributedParams, planeSize)
                            FIELD(DistributedParams, factoringError) FIELD(DistributedParams, factoringRadius) FIELD(
                                DistributedParams, blurWidth) FIELD(DistributedParams, blurExponent)
                                FIELD(DistributedParams, shutterWidth) FIELD(DistributedParams, shutterExponent)
                                    FIELD(DistributedParams, leastRadius) FIELD(DistributedParams, irradianceWidth)
                                        FIELD(DistributedParams, countExponent)
                                            FIELD(DistributedParams, varianceSpread) FIELD(DistributedParams, rays)
                                                FIELD(DistributedParams, values) FIELD(DistributedParams, oneVelocity)
                                                    FIELD(DistributedParams, never) FIELD(DistributedParams, samples)
                                                        FIELD(DistributedParams, published)
                                                            FIELD(DistributedParams, frames)
                                                                FIELD(DistributedParams, still)
                                                                    FIELD(DistributedParams, packed)
                                                                        FIELD(DistributedParams, plainTexture)
                                                                            FIELD(DistributedParams, alongMotion)
                                                                                END(DistributedParams)
