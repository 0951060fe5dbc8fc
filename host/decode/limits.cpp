#include "host/decode/limits.h"

#include "host/decode/failure.h"

#include <string>

namespace wedge::decode {

void Limits::admit(Size size, std::size_t fileBytes) const
{
    const std::string claim = std::to_string(size.width) + "x" + std::to_string(size.height) + " pixels";
    if (size.width < 1 || size.height < 1)
        throw Failure("it has " + claim);
    if (size.width > side || size.height > side)
        throw Failure(
            "it has " + claim + ", at most " + std::to_string(side) + " a side are read", "scale the image down");
    if (size.pixels() > pixels)
        throw Failure("it has " + claim + ", at most " + std::to_string(pixels) + " are read", remedy);
    const std::int64_t perByte = size.pixels() > 2 * unquestioned ? usualPixelsPerByte : mostPixelsPerByte;
    if (size.pixels() > unquestioned && size.pixels() / perByte > static_cast<std::int64_t>(fileBytes))
        throw Failure("it claims " + claim + " in " + std::to_string(fileBytes) + " bytes", remedy);
    if (size.pixels() > together)
        throw Failure("it has " + claim + ", of the textures of all the scene only " + std::to_string(together)
                + " more are read",
            remedy);
    if (admitted != nullptr)
        *admitted += size.pixels();
}

} // namespace wedge::decode
