#include "host/render/image_filter.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace wedge::render {
namespace {

std::vector<std::unique_ptr<const ImageFilter>>& registered()
{
    static std::vector<std::unique_ptr<const ImageFilter>> all;
    return all;
}

const ImageFilter& filterOf(const ChosenFilter& chosen)
{
    const ImageFilter* filter = imageFilter(chosen.name);
    if (filter == nullptr || filter->parameters().size() != chosen.values.size()) {
        throw std::logic_error("no filter \"" + chosen.name + "\" of so many parameters is registered");
    }
    return *filter;
}

} // namespace

const std::vector<std::unique_ptr<const ImageFilter>>& imageFilters() { return registered(); }

const ImageFilter* imageFilter(const std::string& name)
{
    const auto found = std::ranges::find_if(registered(), [&](const auto& each) { return each->name() == name; });
    return found != registered().end() ? found->get() : nullptr;
}

void registerImageFilter(std::unique_ptr<const ImageFilter> filter) { registered().push_back(std::move(filter)); }

std::string describe(const std::vector<ChosenFilter>& filters)
{
    std::string out;
    for (const ChosenFilter& chosen : filters) {
        out += (out.empty() ? "" : " ") + chosen.name;
        const std::vector<FilterParameter> parameters = filterOf(chosen).parameters();
        for (std::size_t i = 0; i < parameters.size(); ++i) {
            out += fmt::format("{}{}={}", i == 0 ? ":" : ",", parameters[i].name, chosen.values[i]);
        }
    }
    return out;
}

graph::Handle<Radiance> filteredImage(FrameBuilder& frame, graph::Handle<Radiance> image)
{
    for (const ChosenFilter& chosen : frame.settings.imageFilters) {
        image = filterOf(chosen).declare(frame, chosen.values, image);
    }
    return image;
}

} // namespace wedge::render
