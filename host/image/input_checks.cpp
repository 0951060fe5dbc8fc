#include "host/image/input_checks.h"

#include "host/error.h"

#include <algorithm>
#include <cerrno>
#include <fcntl.h>
#include <filesystem>
#include <fmt/format.h>
#include <system_error>
#include <unistd.h>

namespace wedge::image {

void requireDecodable(const std::string& path, std::int64_t width, std::int64_t height, std::int64_t bytesPerPixel)
{
    constexpr std::int64_t maxPixels = std::int64_t { 1 } << 28;
    constexpr std::int64_t alwaysAllowed = std::int64_t { 1 } << 30;
    const std::string size = fmt::format("{}x{} pixels", width, height);
    if (width <= 0 || height <= 0)
        failToRead(path, "image", "it has " + size);
    if (width > maxPixels / height)
        throw Error(
            fmt::format("image is too large ({}, at most {} are read)", size, maxPixels), path, "use a smaller image");
    std::error_code ignored;
    const auto fileBytes = static_cast<std::int64_t>(std::filesystem::file_size(path, ignored));
    if (width * height > std::max(alwaysAllowed, fileBytes * 4096) / std::max<std::int64_t>(bytesPerPixel, 1))
        failToRead(path, "image", fmt::format("it claims {} in {} bytes", size, fileBytes));
}

void failToRead(const std::string& path, const std::string& format, const std::string& reason)
{
    std::string line = reason;
    std::replace(line.begin(), line.end(), '\n', ' ');
    throw Error(fmt::format("cannot read {} ({})", format, line), path, "check that the file is whole and of its type");
}

void requireReadableFile(const std::string& path, const std::string& format)
{
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status))
        throw Error(fmt::format("cannot read {} (no such file)", format), path, "check the name");
    if (std::filesystem::is_directory(status))
        throw Error(fmt::format("cannot read {} (it is a directory)", format), path, "name a file in it");
    if (faccessat(AT_FDCWD, path.c_str(), R_OK, AT_EACCESS) != 0)
        throw Error(fmt::format("cannot read {} ({})", format, std::generic_category().message(errno)), path,
            "check the permissions");
    if (std::filesystem::is_regular_file(status) && std::filesystem::file_size(path, error) == 0)
        failToRead(path, format, "it is empty");
}

} // namespace wedge::image
