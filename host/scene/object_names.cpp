#include "host/scene/object_names.h"

namespace wedge::scene {

bool isCalledOneOf(const std::string& object, const std::set<std::string>& names)
{
    for (std::size_t slash = object.find('/'); slash != std::string::npos; slash = object.find('/', slash + 1)) {
        if (names.contains(object.substr(0, slash)))
            return true;
    }
    return names.contains(object);
}

std::set<std::string> allNames(const std::vector<std::string>& objects)
{
    std::set<std::string> names;
    for (const std::string& object : objects) {
        for (std::size_t slash = object.find('/'); slash != std::string::npos; slash = object.find('/', slash + 1))
            names.insert(object.substr(0, slash));
        names.insert(object);
    }
    return names;
}

} // namespace wedge::scene
