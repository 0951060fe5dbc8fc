#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace wedge::benchmark {

/// Threads that take chunks of a range from one counter, and sleep between runs, so that they cost nobody else
/// anything. All of them flush denormals to zero, as Embree's documentation advises.
class Workers {
public:
    explicit Workers(unsigned threads);
    ~Workers();
    Workers(const Workers&) = delete;
    Workers& operator=(const Workers&) = delete;

    unsigned threads() const { return static_cast<unsigned>(threads_.size()); }

    /// Calls work(first, last) for chunks of at most `grain` that cover 0..count, and returns when all are done.
    void run(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& work);

private:
    void loop();

    std::mutex mutex_;
    std::condition_variable wake_, done_;
    unsigned long round_ = 0;
    std::size_t busy_ = 0;
    bool stop_ = false;
    std::size_t count_ = 0, grain_ = 1;
    const std::function<void(std::size_t, std::size_t)>* work_ = nullptr;
    std::atomic<std::size_t> next_ { 0 };
    std::vector<std::thread> threads_;
};

} // namespace wedge::benchmark
