#include "data/generator/cornell.h"

#include <cmath>
#include <numbers>

#include "data/generator/shapes.h"
#include "data/generator/skin.h"

namespace wedge::generator {
namespace {

constexpr double pi = std::numbers::pi;
constexpr int sides = 96, rows = 676; ///< of the serpent's skin
constexpr int scale = 8; ///< a scale is so many sides wide and so many rows long
constexpr double eyeToSnout = 0.18, eyeAngle = 1.05; ///< where the eyes are: along the body, and from the back
constexpr double pedestalTop = 0.14;

double smoothstep(double from, double to, double x)
{
    const double t = glm::clamp((x - from) / (to - from), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

double bell(double x, double width) { return std::exp(-0.5 * x * x / (width * width)); }

/// The middle of the body and its radius (w), from the tip of the tail to the snout: one and a half turns on the
/// pedestal, each inside the one before, then up and forward.
std::vector<glm::dvec4> bodyLine()
{
    std::vector<glm::dvec4> control;
    const auto onCoil = [&](double degrees, double away, double up, double radius) {
        const double angle = glm::radians(degrees);
        control.push_back({ away * std::sin(angle), pedestalTop + up, away * std::cos(angle), radius });
    };
    for (int i = 0; i <= 18; ++i) { // 30 degrees a step
        const double t = i / 18.0;
        const double radius = 0.002 + 0.094 * smoothstep(-0.25, 0.95, t);
        onCoil(-666 + 540 * t, 0.62 - 0.36 * t, 0.97 * radius + 0.25 * bell(t, 0.055), radius);
    }
    onCoil(-92, 0.245, 0.125, 0.095);
    onCoil(-56, 0.235, 0.18, 0.094);
    onCoil(-18, 0.215, 0.25, 0.092);
    onCoil(24, 0.19, 0.325, 0.089);
    onCoil(70, 0.155, 0.4, 0.085);
    const glm::dvec4 rest[] = { { 0.12, 0.475, -0.09, 0.08 }, { 0.04, 0.55, -0.19, 0.075 },
        { -0.06, 0.64, -0.215, 0.071 }, { -0.12, 0.735, -0.16, 0.068 }, { -0.12, 0.795, -0.06, 0.068 },
        { -0.085, 0.81, 0.045, 0.077 }, { -0.045, 0.795, 0.13, 0.095 }, { -0.01, 0.76, 0.205, 0.086 },
        { 0.02, 0.715, 0.275, 0.066 }, { 0.045, 0.67, 0.335, 0.054 } };
    for (const glm::dvec4& p : rest)
        control.push_back(p + glm::dvec4(0, pedestalTop, 0, 0));
    return curveThrough(control, 40);
}

/// One ring's place on the body.
struct Station {
    Frame frame;
    double radius, toSnout; ///< toSnout: length along the body
};

/// Twists the neck so that the head's back is above.
void holdHeadUp(std::vector<Station>& places)
{
    const Frame head = places.back().frame;
    const glm::dvec3 above(0, 1, 0);
    const double twist = std::atan2(glm::dot(above, head.left), glm::dot(above, head.up));
    for (Station& place : places) {
        Frame& f = place.frame;
        const double angle = twist * smoothstep(1.45, 0.4, place.toSnout);
        f = frameAt(f.at, f.along, std::cos(angle) * f.up + std::sin(angle) * f.left);
    }
}

/// The rings' places: nearer to each other where the body is thinner.
std::vector<Station> stations()
{
    const std::vector<glm::dvec4> line = bodyLine();
    std::vector<double> length { 0.0 }, rank { 0.0 };
    for (std::size_t k = 1; k < line.size(); ++k) {
        const double step = glm::length(glm::dvec3(line[k] - line[k - 1]));
        length.push_back(length.back() + step);
        rank.push_back(rank.back() + step / (line[k].w + 0.03));
    }
    std::vector<Station> places;
    std::size_t k = 0;
    for (int i = 0; i < rows; ++i) {
        const double wanted = rank.back() * i / (rows - 1);
        while (k + 2 < line.size() && rank[k + 1] < wanted)
            ++k;
        const double t = (wanted - rank[k]) / (rank[k + 1] - rank[k]);
        const glm::dvec4 p = line[k] + t * (line[k + 1] - line[k]);
        const double toSnout = length.back() - length[k] - t * (length[k + 1] - length[k]);
        const std::size_t last = line.size() - 1, reach = 8;
        const glm::dvec3 along = line[std::min(k + 1 + reach, last)] - line[k < reach ? 0 : k - reach];
        // Carried along the line, so that the rings do not twist against each other.
        const glm::dvec3 back = places.empty() ? glm::dvec3(0, 1, 0) : places.back().frame.up;
        places.push_back({ frameAt(glm::dvec3(p), along, back), p.w, toSnout });
    }
    holdHeadUp(places);
    return places;
}

/// How far the skin is from the body's middle, at an angle from the back, in row `row`.
double skinRadius(const Station& s, int row, double angle, double total)
{
    const double side = std::abs(std::remainder(angle, 2.0 * pi)); // 0 on the back, pi on the belly
    const double head = smoothstep(0.43, 0.3, s.toSnout), body = 1.0 - head;
    const double x = pi * row / scale, y = angle * sides / (2.0 * scale);
    const double scales = std::pow(std::abs(std::sin(x + y) * std::sin(x - y)), 0.7);
    const double plates = std::pow(std::abs(std::sin(x)), 0.6);
    const double belly = smoothstep(2.25, 2.5, side);
    const double crest = bell(side, 0.11) * (0.35 + 0.65 * std::pow(std::abs(std::sin(x)), 1.5));
    double r = s.radius * (1.0 + (0.1 - 0.06 * head) * glm::mix(scales, 0.7 * plates, belly) + 0.42 * body * crest);
    // The head is broad and flat, with brows, nostrils and a mouth.
    const double broad = std::sin(side), high = std::cos(side);
    r *= 1.0 + head * (0.22 * broad * broad - 0.2 * high * high);
    r += 0.026 * bell(s.toSnout - 0.2, 0.035) * bell(side - 0.65, 0.18);
    r += 0.01 * bell(s.toSnout - 0.04, 0.018) * bell(side - 0.6, 0.2);
    r -= 0.014 * bell(s.toSnout - eyeToSnout, 0.024) * bell(side - eyeAngle, 0.22);
    r -= 0.011 * smoothstep(0.25, 0.21, s.toSnout) * bell(side - 2.0, 0.09);
    const double snout = glm::clamp(1.0 - s.toSnout / 0.04, 0.0, 1.0);
    const double tail = glm::clamp(1.0 - (total - s.toSnout) / 0.02, 0.0, 1.0);
    return r * std::sqrt(1.0 - snout * snout) * std::sqrt(1.0 - tail * tail);
}

/// A thin curved cone with a rounded tip, from a point in the skin: horns and whiskers.
void spike(ObjWriter& mesh, const std::vector<glm::dvec3>& control, double radius, int around)
{
    const std::vector<Frame> frames = framesOn(curveThrough(control, 10), { 0, 1, 0 });
    std::vector<Ring> rings;
    for (std::size_t k = 0; k < frames.size(); ++k) {
        const double t = static_cast<double>(k) / static_cast<double>(frames.size() - 1);
        rings.push_back(ringAround(frames[k], around, radius * (1.0 - 0.8 * t) * std::sqrt(1.0 - std::pow(t, 8.0))));
    }
    skin(mesh, rings);
}

void headPieces(ObjWriter& mesh, const std::vector<Station>& places)
{
    const auto near = [&](double toSnout) {
        std::size_t k = 0;
        while (k + 1 < places.size() && places[k].toSnout > toSnout)
            ++k;
        return places[k];
    };
    for (const double hand : { -1.0, 1.0 }) {
        const auto from = [&](const Station& s, double along, double up, double left) {
            return s.frame.at + along * s.frame.along + up * s.frame.up + hand * left * s.frame.left;
        };
        const Station eye = near(eyeToSnout), horn = near(0.3), nose = near(0.045);
        mesh.object(hand < 0 ? "eye_right" : "eye_left", "eyes");
        const double out = skinRadius(eye, 0, eyeAngle, places[0].toSnout) - 0.006;
        sphere(mesh, from(eye, 0.0, out * std::cos(eyeAngle), out * std::sin(eyeAngle)), 0.022, 16, 32);
        mesh.object(hand < 0 ? "horn_right" : "horn_left", "horns");
        spike(mesh,
            { from(horn, 0.02, 0.04, 0.04), from(horn, -0.04, 0.105, 0.07), from(horn, -0.13, 0.13, 0.115),
                from(horn, -0.21, 0.17, 0.13), from(horn, -0.26, 0.24, 0.11) },
            0.022, 20);
        mesh.object(hand < 0 ? "whisker_right" : "whisker_left", "horns");
        spike(mesh,
            { from(nose, 0.0, 0.0, 0.03), from(nose, 0.03, -0.01, 0.09), from(nose, 0.01, -0.07, 0.16),
                from(nose, -0.03, -0.1, 0.22), from(nose, -0.05, -0.06, 0.28), from(nose, -0.04, 0.0, 0.3) },
            0.0055, 12);
    }
}

} // namespace

GeneratedScene makeCornellFigure()
{
    GeneratedScene s = cornellBox("cornell_figure", "A Cornell box with a scaly serpent on a pedestal");
    s.materials.push_back(matt("pedestal", glm::vec3(0.7f, 0.68f, 0.64f)));
    s.materials.push_back(matt("serpent", glm::vec3(0.46f, 0.37f, 0.22f)));
    s.materials.push_back(matt("horns", glm::vec3(0.36f, 0.33f, 0.28f)));
    s.materials.push_back(matt("eyes", glm::vec3(0.06f, 0.05f, 0.05f)));
    s.mesh.object("pedestal", "pedestal"); // it goes into the floor, so that no faces coincide
    const double top = pedestalTop;
    const std::vector<glm::dvec3> profile { { 0, -0.01, 0 }, { 0.72, -0.01, 0 }, { 0.74, 0, 0 }, { 0.74, 0.03, 0 },
        { 0.71, 0.05, 0 }, { 0.69, 0.07, 0 }, { 0.7, 0.085, 0 }, { 0.72, 0.1, 0 }, { 0.72, 0.125, 0 }, { 0.7, top, 0 },
        { 0.35, top, 0 }, { 0, top, 0 } };
    skin(s.mesh, turned(profile, 4, 96));
    const std::vector<Station> places = stations();
    std::vector<Ring> rings;
    for (int row = 0; row < rows; ++row) {
        const Station& place = places[static_cast<std::size_t>(row)];
        rings.push_back(ringAround(
            place.frame, sides, [&](double angle) { return skinRadius(place, row, angle, places[0].toSnout); }));
    }
    s.mesh.object("serpent", "serpent");
    skin(s.mesh, rings);
    headPieces(s.mesh, places);
    return s;
}

} // namespace wedge::generator
