// The cache of compiled kernels that a driver keeps by itself, kept where a damaged one can be emptied.
#pragma once

#include <filesystem>
#include <string>

namespace wedge::device {

/// PoCL keeps what it compiled in a folder of its own and loads it unchecked: a file there that a full disk or a power
/// cut has damaged ends the process inside the driver, at every start. So its cache lies in a folder of ours. A process
/// leaves a mark there for as long as it compiles kernels or fetches them, and then records what the files are. A mark
/// that outlived its process tells at the next start that the driver may have died of what is in the folder, which is
/// then emptied, unless another process is at work there. Files that are not what the record says are removed.
class DriverCache {
public:
    /// root: the folder of our caches; empty: the driver keeps its cache where it likes, and there are no marks.
    explicit DriverCache(const std::filesystem::path& root);

    /// The cache of this process, in CacheRoot's folder. The first call comes before the first call of OpenCL: it
    /// points the driver to the folder (POCL_CACHE_DIR, unless the user has set it or there is no such folder to be
    /// had) and removes from it what it has to.
    static DriverCache& ofProcess();

    /// Empties the folder if a process died while it held a mark there and no process holds one now; else removes what
    /// is damaged. users: the folder that the user chose in our place, which is left alone; "" for none. Keeps what
    /// there is to say in notice().
    void recover(const std::string& users);

    /// What recover() found, one line for the user, or "".
    const std::string& notice() const { return notice_; }

    /// Where the driver's files go, see ownCacheFolder(); empty where the driver keeps them where it likes.
    const std::filesystem::path& folder() const { return folder_; }

    /// The mark of this process, held while kernels are compiled or fetched. Several of a process share one. Whatever
    /// goes wrong with the disk means no mark, never an error.
    class Mark {
    public:
        explicit Mark(DriverCache& cache = ofProcess());
        ~Mark();
        Mark(const Mark&) = delete;
        Mark& operator=(const Mark&) = delete;

    private:
        DriverCache& cache_;
    };

private:
    void setMark();
    void removeMark();

    std::filesystem::path folder_;
    std::string notice_;
    int holders_ = 0; ///< marks of this process; programs are not built by several threads at once
    int file_ = -1; ///< of its mark, locked
    std::filesystem::path mark_;
};

} // namespace wedge::device
