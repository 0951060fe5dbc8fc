#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "host/scene/point_tree.h"

namespace wedge::scene {

/// What became of a face.
enum class Split {
    Whole, ///< its triangles cover it once
    Crossed, ///< its outline crosses itself or the face is folded: parts may be covered twice, or not at all
    NoArea, ///< all its corners lie on one line, or its outline goes back the way it came
};

/// Splits faces into triangles. Corners on one line, repeated ones, and holes that a bridge walked twice connects to
/// the outline are as good as any.
class Triangulator {
public:
    /// The triangles are in triangles() until the next call, as indices of corners, which go around as the face's do;
    /// none of them has no area. corners: at least 4.
    ///
    /// A face of 4 is split by its shorter diagonal, if that is inside. Larger ones lose an ear after the other:
    /// orientations are exact, a tree finds the corners in the way, and the work is bounded by a constant a corner.
    /// Where no ear is left, because the outline crosses itself, the smallest corner is cut off.
    Split split(std::span<const glm::dvec3> corners);

    const std::vector<std::array<std::uint32_t, 3>>& triangles() const { return triangles_; }

private:
    enum class Turn : std::uint8_t { Gone, Convex, Reflex, Straight };
    struct Vertex {
        std::uint32_t before = 0, after = 0;
        std::uint32_t version = 0; ///< of its neighbours: what was found out about others is out of date
        Turn turn = Turn::Gone;
    };
    struct Candidate {
        double size;
        std::uint32_t vertex, version;
        bool operator<(const Candidate& other) const { return size > other.size; } // the heap's top is the smallest
    };

    Split splitQuad(std::span<const glm::dvec3> corners);
    void project(std::span<const glm::dvec3> corners);
    void start();
    bool windsTwice() const;
    void classify(std::uint32_t vertex);
    void settle();
    void unlink(std::uint32_t vertex);
    void cut(std::uint32_t vertex);
    bool isEar(std::uint32_t vertex);
    bool blocks(std::uint32_t other, std::uint32_t vertex) const;
    void push(std::vector<Candidate>& heap, double size, std::uint32_t vertex) const;
    std::optional<std::uint32_t> pop(std::vector<Candidate>& heap) const;
    bool turnRound();
    double areaAt(std::uint32_t vertex) const;

    std::vector<std::array<std::uint32_t, 3>> triangles_;
    std::vector<glm::dvec2> points_; ///< the corners in the plane, where the face goes around counter-clockwise
    std::vector<Vertex> ring_;
    std::vector<std::uint32_t> stale_; ///< whose neighbours changed
    std::vector<Candidate> queue_; ///< heap of convex vertices, the shortest diagonal first: it makes no slivers
    std::vector<Candidate> blocked_; ///< heap of those that are no ears, the smallest area first
    PointTree obstacles_; ///< on: corners that are not convex, while hasObstacles_
    bool hasObstacles_ = false;
    std::size_t left_ = 0, steps_ = 0;
    double area_ = 0.0, lost_ = 0.0; ///< doubled: of all triangles, and of those that may lie wrong
};

} // namespace wedge::scene
