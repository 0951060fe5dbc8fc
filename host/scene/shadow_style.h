#pragma once

#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace wedge::scene {

/// A number or a colour that goes by how far from the point in shadow what throws the shadow is, by d metres along the
/// ray to the light: constant + linear d + square d^2.
template <class T>
struct Knob {
    T constant, linear, square;

    Knob(const T& c = T(0.0f), const T& l = T(0.0f), const T& s = T(0.0f))
        : constant(c)
        , linear(l)
        , square(s)
    {
    }

    bool varies() const { return linear != T(0.0f) || square != T(0.0f); }
    bool operator==(const Knob&) const = default;
};

/// How a light's shadow is drawn; docs/stylized-shadows.md has the equations. A light may have several, each of a
/// share of its light.
struct ShadowStyle {
    float weight = 1.0f; ///< its share; those of a light with the same casters add up to 1
    Knob<float> inflation; ///< metres that the edge moves outwards
    Knob<float> softness; ///< metres over which the edge goes from dark to bright
    Knob<float> abstraction; ///< metres: standard deviation of what smooths the shadow's outline
    Knob<glm::vec3> brightness; ///< of the light, what is left in shadow, 0 to 1
    float penumbra = 1.0f; ///< of soft shadows: how wide the penumbra is beside what it was, 0 to 1
    bool keepArea = true; ///< a smoothed shadow is as large as before
    /// Names of objects, or what they begin with up to a slash: those whose shadows are drawn so, and those on which
    /// they are. Empty: all.
    std::vector<std::string> casters, receivers;

    /// Of one that changes over time: what it is at its keys. All else is as of the moment. Empty: it never changes.
    std::vector<ShadowStyle> keys;

    bool operator==(const ShadowStyle&) const = default;
};

} // namespace wedge::scene
