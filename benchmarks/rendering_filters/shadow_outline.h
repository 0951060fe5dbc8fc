#pragma once

#include "host/render/renderer.h"

#include <cstddef>
#include <random>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace wedge::benchmark {

/// What a frame shows of a light's hard shadow, and the shadow's outline on surfaces, on the host in double.
class ShadowOutline {
public:
    /// Of the renderer's last frame, whose layers were kept. light: what the names of the light's layers end in.
    ShadowOutline(render::Renderer& renderer, const std::string& light);

    /// Of edge, by marching squares; docs/stylized-shadows.md.
    std::size_t pieces() const { return pieces_.size(); }
    /// Those of which it is known whether they are in shadow; indices of planes.
    const std::vector<std::size_t>& pixels() const { return pixels_; }

    /// Metres to the edge, below 0 in shadow, as the device has it: no more than the style tells apart.
    double onDevice(std::size_t pixel) const { return double { distance_[pixel] }; }
    /// The same as a power mean over all pieces whose surfaces face as the pixel's does; infinite where there are none.
    double byAll(std::size_t pixel) const;
    /// The same of so many pieces that are picked at random.
    double bySome(std::size_t pixel, int count, std::mt19937_64& random) const;

private:
    struct Piece {
        glm::dvec3 middle, normal;
        double length;
    };

    glm::dvec3 vectorAt(const std::vector<float>& planes, std::size_t first, std::size_t pixel) const;
    bool onOneSurface(std::size_t a, std::size_t b) const;
    void addPieces(std::size_t corner);
    /// len / r^8 of a piece, where it counts.
    double share(const Piece& piece, const glm::dvec3& at, const glm::dvec3& normal) const;
    double distanceOf(double sum, std::size_t pixel) const;

    graph::PlaneLayout layout_;
    std::size_t normals_; ///< where in normal_ those of the surface itself begin
    std::vector<float> position_, normal_, pixelSize_, matte_, distance_;
    std::vector<std::uint32_t> object_;
    std::vector<Piece> pieces_;
    std::vector<std::size_t> pixels_;
};

} // namespace wedge::benchmark
