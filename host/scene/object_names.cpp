#include "host/scene/object_names.h"

#include <set>

namespace wedge::scene {

bool isCalled(const std::string& object, const std::string& name)
{
    return object.starts_with(name) && (object.size() == name.size() || object[name.size()] == '/');
}

std::vector<std::string> allNames(const std::vector<std::string>& objects)
{
    std::set<std::string> names;
    for (const std::string& object : objects) {
        for (std::size_t slash = object.find('/'); slash != std::string::npos; slash = object.find('/', slash + 1))
            names.insert(object.substr(0, slash));
        names.insert(object);
    }
    return { names.begin(), names.end() };
}

} // namespace wedge::scene
