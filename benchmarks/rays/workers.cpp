#include "benchmarks/rays/workers.h"

#include <algorithm>

#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace wedge::benchmark {
namespace {

void flushDenormals()
{
#if defined(__x86_64__)
    constexpr unsigned flushToZero = 0x8000, denormalsAreZero = 0x0040;
    _mm_setcsr(_mm_getcsr() | flushToZero | denormalsAreZero);
#endif
}

} // namespace

Workers::Workers(unsigned threads)
{
    for (unsigned i = 0; i < std::max(1u, threads); ++i)
        threads_.emplace_back([this] { loop(); });
}

Workers::~Workers()
{
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    wake_.notify_all();
    for (std::thread& thread : threads_)
        thread.join();
}

void Workers::run(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& work)
{
    std::unique_lock lock(mutex_);
    count_ = count;
    grain_ = grain;
    work_ = &work;
    next_ = 0;
    busy_ = threads_.size();
    ++round_;
    wake_.notify_all();
    done_.wait(lock, [this] { return busy_ == 0; });
}

void Workers::loop()
{
    flushDenormals();
    unsigned long seen = 0;
    for (;;) {
        {
            std::unique_lock lock(mutex_);
            wake_.wait(lock, [&] { return stop_ || round_ != seen; });
            if (stop_)
                return;
            seen = round_;
        }
        for (std::size_t first = next_.fetch_add(grain_); first < count_; first = next_.fetch_add(grain_))
            (*work_)(first, std::min(first + grain_, count_));
        const std::lock_guard lock(mutex_);
        if (--busy_ == 0)
            done_.notify_one();
    }
}

} // namespace wedge::benchmark
