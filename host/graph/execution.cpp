#include "host/graph/execution.h"

#include "kernels/shared/frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <functional>
#include <stdexcept>

namespace wedge::graph {
namespace {

constexpr std::size_t rowsOfGroup = 64; ///< items of a work-group over rows
constexpr int bandPixels = 1 << 21; ///< of a launch over rows, so that none is long

/// In the place of a pass's window where nothing is to be computed.
Window nothing(const Window& window) { return { window.x0, window.y0, window.x0, window.y1 }; }

/// Whether two resources that live at the same time share bytes.
bool overlap(const Plan& plan, std::size_t a, std::size_t b)
{
    const std::vector<Resource>& all = plan.graph.resources();
    if (all[a].imported || all[b].imported || plan.places[a].slab != plan.places[b].slab) {
        return false;
    }
    const std::uint64_t from = plan.places[a].offset, other = plan.places[b].offset;
    return from < other + all[b].bytes() && other < from + all[a].bytes();
}

void requireApart(const Plan& plan)
{
    for (std::size_t a = 0; a < plan.lifetimes.size(); ++a) {
        for (std::size_t b = 0; b < a; ++b) {
            if (plan.lifetimes[a] && plan.lifetimes[b] && plan.lifetimes[a]->meets(*plan.lifetimes[b])
                && overlap(plan, a, b)) {
                throw std::logic_error(fmt::format("\"{}\" and \"{}\" are needed at once, and lie in the same memory",
                    plan.graph.resources()[a].name, plan.graph.resources()[b].name));
            }
        }
    }
}

} // namespace

device::Kernel& Kernels::find(const device::ProgramSource& program, const std::string& kernel)
{
    const std::pair key(program, kernel);
    const auto found = kernels_.find(key);
    return found != kernels_.end() ? found->second
                                   : kernels_.emplace(key, library_.kernel(program, kernel)).first->second;
}

std::set<device::ProgramSource> Kernels::programs() const
{
    std::set<device::ProgramSource> out;
    for (const auto& [name, kernel] : kernels_) {
        out.insert(name.first);
    }
    return out;
}

void Memory::hold(const std::vector<std::uint64_t>& slabs)
{
    const auto same = [](const device::Buffer<std::uint8_t>& there, std::uint64_t bytes) {
        return there.bytes() == bytes;
    };
    if (std::equal(slabs_.begin(), slabs_.end(), slabs.begin(), slabs.end(), same)) {
        return;
    }
    slabs_.clear(); // before there is more
    for (const std::uint64_t bytes : slabs) {
        slabs_.emplace_back(device_, bytes, "planes");
    }
}

std::uint64_t Memory::bytes() const
{
    std::uint64_t sum = 0;
    for (const device::Buffer<std::uint8_t>& slab : slabs_) {
        sum += slab.bytes();
    }
    return sum;
}

const Resource& Run::used(const Version& version) const
{
    for (const Argument& use : pass_->pass->arguments) {
        if (use.isUse() && use.version.resource == version.resource && version.graph == use.version.graph) {
            return execution_->plan_.graph.resources()[version.resource];
        }
    }
    throw std::logic_error(fmt::format("the step of pass \"{}\" asks for what it does not use", pass_->pass->name));
}

const cl::Buffer& Run::memory(const Version& version) const { return execution_->memory_[version.resource]; }

Execution::Execution(const Plan& plan, Memory& memory, Kernels& kernels, device::TimedQueue& queue)
    : plan_(plan)
    , kernels_(kernels)
    , queue_(queue)
    , memory_(plan.lifetimes.size())
{
    requireApart(plan);
    memory.hold(plan.slabs);
    for (std::size_t i = 0; i < memory_.size(); ++i) {
        const Resource& resource = plan.graph.resources()[i];
        if (resource.imported) {
            memory_[i] = *resource.imported;
        } else if (plan.lifetimes[i]) {
            const Place& place = plan.places[i];
            const device::Buffer<std::uint8_t>& slab = memory.slab(place.slab);
            memory_[i] = plan.sharing == Sharing::Turns
                ? slab.cl()
                : slab.part<std::uint8_t>(place.offset, static_cast<std::size_t>(resource.bytes()), resource.name).cl();
        }
    }
}

bool Execution::run(const std::atomic<bool>* stop, bool poison)
{
    Run run(queue_, false, stop);
    run.execution_ = this;
    poison_ = poison;
    runRange(run, 0, plan_.passes.size(), -1);
    return !run.cut();
}

ChangingValues Execution::changingValues()
{
    const Run run(queue_, false, nullptr);
    ChangingValues out;
    for (const PlannedPass& planned : plan_.passes) {
        for (const Argument& argument : planned.pass->arguments) {
            if (argument.changing) {
                out.push_back(argument.value({ run, planned.window }));
            }
        }
    }
    return out;
}

bool Execution::runAgain(const ChangingValues& before, const std::atomic<bool>* stop)
{
    assert(plan_.runsAgain);
    const ChangingValues now = changingValues();
    std::vector<bool> first(plan_.passes.size());
    std::size_t value = 0;
    for (std::size_t i = 0; i < plan_.passes.size(); ++i) {
        for (const Argument& argument : plan_.passes[i].pass->arguments) {
            if (argument.changing) {
                first[i] = first[i] || now[value] != before.at(value);
                ++value;
            }
        }
    }
    left_ = dependents(plan_.graph, plan_.passes, std::move(first));
    left_.flip();
    const bool whole = run(stop);
    left_.clear();
    return whole;
}

void Execution::rehearse()
{
    Run run(queue_, true, nullptr);
    run.execution_ = this;
    poison_ = false;
    runRange(run, 0, plan_.passes.size(), -1);
}

std::vector<Trial> Execution::trials()
{
    std::vector<Trial> found;
    trials_ = &found;
    rehearse();
    trials_ = nullptr;
    return found;
}

bool Execution::leavesOut(std::size_t begin, std::size_t end) const
{
    return !left_.empty()
        && std::all_of(left_.begin() + static_cast<std::ptrdiff_t>(begin),
            left_.begin() + static_cast<std::ptrdiff_t>(end), std::identity());
}

void Execution::runRange(Run& run, std::size_t begin, std::size_t end, int loop)
{
    for (std::size_t i = begin; i < end;) {
        int inner = plan_.passes[i].pass->loop;
        if (inner == loop) {
            if (!leavesOut(i, i + 1)) {
                runPass(run, plan_.passes[i]);
            }
            ++i;
            continue;
        }
        while (plan_.graph.loops()[static_cast<std::size_t>(inner)].parent != loop) {
            inner = plan_.graph.loops()[static_cast<std::size_t>(inner)].parent;
        }
        std::size_t last = i;
        while (last < end && plan_.graph.holds(inner, plan_.passes[last].pass->loop)) {
            ++last;
        }
        const Loop& body = plan_.graph.loops()[static_cast<std::size_t>(inner)];
        const std::size_t count = leavesOut(i, last) ? 0 : run.rehearsal() ? 1 : body.count(run);
        // Whoever stops ends what is repeated; conditions say themselves what is left out then.
        for (std::size_t k = 0; k < count; ++k) {
            if (body.repeats && run.stopped()) {
                run.cut_ = true;
                break;
            }
            run.iterations_.push_back(k);
            runRange(run, i, last, inner);
            run.iterations_.pop_back();
        }
        i = last;
    }
}

void Execution::runPass(Run& run, const PlannedPass& planned)
{
    const Pass& pass = *planned.pass;
    run.pass_ = &planned;
    if (poison_) {
        fillNew(planned);
    }
    if (!run.rehearsal() && pass.condition && !pass.condition(run)) {
        return;
    }
    if (pass.domain == Domain::Host) {
        pass.step(run);
        return;
    }
    queue_.setCancelFlag(pass.stoppable ? run.stop_ : nullptr);
    try {
        launch(run, planned);
    } catch (const device::Cancelled&) {
        run.cut_ = true;
    }
    queue_.setCancelFlag(nullptr);
}

void Execution::fillNew(const PlannedPass& planned)
{
    constexpr std::uint8_t ones = 0xff;
    for (const Argument& use : planned.pass->arguments) {
        const std::uint32_t i = use.version.resource;
        const auto position = static_cast<std::uint32_t>(&planned - plan_.passes.data());
        if (use.isUse() && !plan_.graph.resources()[i].imported && plan_.lifetimes[i]->first == position) {
            queue_.fill("poison", memory_[i], plan_.graph.resources()[i].bytes(), &ones, 1);
        }
    }
}

void Execution::setArguments(Run& run, device::Kernel& kernel, const PlannedPass& planned, const Window& window) const
{
    unsigned index = 0;
    for (const Argument& argument : planned.pass->arguments) {
        if (argument.isUse()) {
            kernel.setArg(index++, memory_[argument.version.resource]);
        } else {
            kernel.setArgBytes(index++, argument.value({ run, window }));
        }
    }
}

void Execution::launch(Run& run, const PlannedPass& planned)
{
    if (run.rehearsal()) {
        rehearse(run, planned);
        return;
    }
    const Pass& pass = *planned.pass;
    device::Kernel& kernel = kernels_.find(*planned.program, pass.kernel.name);
    const bool tiles = pass.domain == Domain::Tiles;
    kernel.requireCount(pass.arguments.size() + (tiles ? 1 : 0));
    if (pass.domain == Domain::Pixels || pass.domain == Domain::Blocks) {
        launchRows(run, kernel, planned);
        return;
    }
    const Window& window = planned.window;
    setArguments(run, kernel, planned, window);
    if (tiles) {
        const std::size_t items = pass.itemsOfTile, local = localSize(kernel, items);
        queue_.launchTiled(pass.name, pass.kind, kernel, pass.count({ run, window }) * (items / local), local,
            kernel.argCount() - 1, pass.workUnits ? pass.workUnits({ run, window }) : 0.0);
    } else {
        const std::size_t items = pass.count ? pass.count({ run, window }) : pass.mostItems;
        assert(items <= pass.mostItems);
        queue_.launch(pass.name, pass.kind, kernel, items, localSize(kernel, pass.mostOfGroup));
    }
}

Trial Execution::trialOf(Run& run, const PlannedPass& planned) const
{
    const Pass& pass = *planned.pass;
    Trial trial { *planned.program, pass.kernel.name, pass.domain };
    Window covered = nothing(planned.window);
    if (pass.domain == Domain::Tiles) {
        trial.items = std::max<std::size_t>(pass.count({ run, planned.window }), 1);
        trial.itemsOfGroup = pass.itemsOfTile;
    } else if (pass.domain == Domain::Items) {
        trial.items = pass.mostItems;
        trial.itemsOfGroup = pass.mostOfGroup;
    } else {
        const Rows rows = rowsOf(planned);
        covered = nothing(rows.all);
        trial.columns = rows.columns;
        trial.rows = static_cast<std::size_t>(std::min(rows.band, rows.all.height()));
        trial.itemsOfGroup = rowsOfGroup;
        trial.columnsOfGroup = rows.columnsOfGroup;
    }
    for (const Argument& argument : pass.arguments) {
        const bool memory = argument.isUse() || argument.type.starts_with("__global");
        trial.arguments.push_back(memory ? std::vector<std::byte>() : argument.value({ run, covered }));
    }
    return trial;
}

void Execution::rehearse(Run& run, const PlannedPass& planned)
{
    const Trial trial = trialOf(run, planned);
    if (trials_ != nullptr) {
        trials_->push_back(trial);
        return;
    }
    const Pass& pass = *planned.pass;
    device::Kernel& kernel = kernels_.find(*planned.program, pass.kernel.name);
    kernel.requireCount(pass.arguments.size() + (pass.domain == Domain::Tiles ? 1 : 0));
    setArguments(run, kernel, planned, nothing(planned.window));
    graph::launch(queue_, pass.name, pass.kind, kernel, trial);
}

Execution::Rows Execution::rowsOf(const PlannedPass& planned) const
{
    const int across = planned.pass->domain == Domain::Pixels ? 1 : static_cast<int>(WEDGE_BLOCK_PIXELS);
    // Results beside the window are nobody's, and may be of nothing.
    const Window all { planned.window.x0 / across * across, planned.window.y0,
        std::min(plan_.graph.image(planned.pass->scale).x1, (planned.window.x1 + across - 1) / across * across),
        planned.window.y1 };
    return { all, static_cast<std::size_t>((all.width() + across - 1) / across),
        std::max(16, bandPixels / std::max(1, all.width())), across == 1 ? std::size_t { 16 } : std::size_t { 4 } };
}

void Execution::launchRows(Run& run, device::Kernel& kernel, const PlannedPass& planned)
{
    const Pass& pass = *planned.pass;
    const auto& [all, columns, band, columnsOfGroup] = rowsOf(planned);
    const std::size_t local = localSize(kernel, rowsOfGroup), localX = std::min(local, columnsOfGroup);
    for (int y = all.y0; y < all.y1; y += std::min(band, all.y1 - y)) {
        const Window rows { all.x0, y, all.x1, y + std::min(band, all.y1 - y) };
        setArguments(run, kernel, planned, rows);
        queue_.launch2D(
            pass.name, pass.kind, kernel, columns, static_cast<std::size_t>(rows.height()), localX, local / localX);
    }
    std::uint64_t bytes = 0;
    for (const Argument& use : pass.arguments) {
        bytes += use.isUse() ? plan_.graph.resources()[use.version.resource].bytes() : 0;
    }
    queue_.addBytes(pass.name, pass.kind, bytes);
}

} // namespace wedge::graph
