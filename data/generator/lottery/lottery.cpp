#include "data/generator/lottery/lottery.h"

#include "data/generator/lottery/stage.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace wedge::generator {

void begin(LotteryScene& s, ObjWriter& mesh, const std::string& name, const std::string& material)
{
    if (s.traits.oneGroup && &mesh == &s.scene.mesh && s.objects > 0) {
        mesh.material(material);
        return;
    }
    mesh.object(s.traits.oneGroup ? "all" : fmt::format("{}_{}", name, s.objects), material);
    ++s.objects;
}

const std::string& oneOf(Random& random, const std::vector<std::string>& list)
{
    return list[static_cast<std::size_t>(whole(random, 0, static_cast<int>(list.size()) - 1))];
}

GeneratedScene makeLottery(std::uint32_t seed, int version)
{
    LotteryScene s;
    s.traits = lotteryTraits(seed, version);
    s.scene.name = fmt::format("lottery{}_{}", version == 1 ? "" : std::to_string(version), seed);
    s.scene.comment = fmt::format("Seed {} of the lottery: {}", seed, fmt::join(hardCases(s.traits), ", "));
    s.scene.bounces = s.traits.bounces;
    s.scene.antialias = s.traits.antialias;
    makeMaterials(s, stream(seed, Stream::Materials));
    makeStage(s, stream(seed, Stream::Stage));
    placeCamera(s, stream(seed, Stream::Camera));
    placeThings(s, stream(seed, Stream::Things), stream(seed, Stream::Motion));
    placeLights(s, stream(seed, Stream::Lights));
    placeEmitters(s, stream(seed, Stream::Emitters));
    s.scene.hasLight = s.traits.quads;
    placeLamps(s, stream(seed, Stream::Lamps));
    makeSky(s, stream(seed, Stream::Sky));
    return std::move(s.scene);
}

} // namespace wedge::generator
