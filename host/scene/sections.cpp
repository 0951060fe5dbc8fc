#include "host/scene/sections.h"

namespace wedge::scene {
namespace {

std::vector<Section>& registry()
{
    static std::vector<Section> registered;
    return registered;
}

} // namespace

void registerSection(Section section) { registry().push_back(std::move(section)); }

const std::vector<Section>& sections() { return registry(); }

} // namespace wedge::scene
