#pragma once

#include "host/image/image.h"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <unistd.h>

namespace wedge::image::test {

/// A directory of its own for one test, removed with all that is in it.
class TempDirectory {
public:
    TempDirectory()
    {
        static int count = 0;
        path_ = std::filesystem::temp_directory_path()
            / ("wedge-image-test-" + std::to_string(getpid()) + "-" + std::to_string(count++));
        std::filesystem::create_directories(path_);
    }
    ~TempDirectory()
    {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TempDirectory(const TempDirectory&) = delete;
    TempDirectory& operator=(const TempDirectory&) = delete;

    std::string operator/(const std::string& name) const { return (path_ / name).string(); }
    std::string path() const { return path_.string(); }
    long entries() const { return std::distance(std::filesystem::directory_iterator(path_), {}); }

private:
    std::filesystem::path path_;
};

inline std::string readBytes(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    return { std::istreambuf_iterator<char>(file), {} };
}

inline void writeBytes(const std::string& path, const std::string& bytes)
{
    std::ofstream(path, std::ios::binary) << bytes;
}

/// A number in [0, 1) from a position and a seed.
inline double hashed(std::uint32_t x, std::uint32_t y, std::uint32_t channel, std::uint32_t seed)
{
    std::uint32_t n = x * 73856093u ^ y * 19349663u ^ channel * 83492791u ^ seed * 2654435761u;
    n ^= n >> 16;
    n *= 0x7feb352du;
    n ^= n >> 15;
    n *= 0x846ca68bu;
    n ^= n >> 16;
    return (n >> 8) / 16777216.0;
}

/// The test card: gradients, an 8-pixel checkerboard at 0.3 of the brightness and a red disc, in doubles.
inline RgbImage testCard(int width, int height)
{
    RgbImage image { width, height, {} };
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const double u = (x + 0.5) / width;
            const double v = (y + 0.5) / height;
            const double dim = (x / 8 + y / 8) % 2 ? 0.3 : 1.0;
            double rgb[3] = { u * dim, v * dim, (0.25 + 0.5 * u * v) * dim };
            const double dx = x - 0.5 * width;
            const double dy = y - 0.5 * height;
            if (dx * dx + dy * dy < 0.04 * width * width) {
                rgb[0] = 0.9;
                rgb[1] = 0.2;
                rgb[2] = 0.1;
            }
            for (const double value : rgb)
                image.rgb.push_back(static_cast<float>(value));
        }
    }
    return image;
}

/// The test card with uniform noise of that peak-to-peak amount on each channel.
inline RgbImage noisyCard(int width, int height, double amount, std::uint32_t seed)
{
    RgbImage image = testCard(width, height);
    for (std::size_t i = 0; i < image.rgb.size(); ++i) {
        const auto pixel = static_cast<std::uint32_t>(i / 3);
        const auto columns = static_cast<std::uint32_t>(width);
        const double noise = hashed(pixel % columns, pixel / columns, static_cast<std::uint32_t>(i % 3), seed) - 0.5;
        image.rgb[i] = static_cast<float>(image.rgb[i] + amount * noise);
    }
    return image;
}

} // namespace wedge::image::test
