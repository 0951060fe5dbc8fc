#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace wedge::benchmark {

/// Runs a program to its end, with the environment's variables and WEDGE_CACHE_DIR set to cache, and its standard
/// output thrown away. Returns the seconds that it took. Throws Error, with what it said on stderr, where it fails.
double secondsOf(
    const std::string& program, const std::vector<std::string>& arguments, const std::filesystem::path& cache);

/// A folder for temporary files, removed with all that is in it.
class TemporaryFolder {
public:
    TemporaryFolder(); ///< Throws Error where there can be none.
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

} // namespace wedge::benchmark
