// kernel_programs FOLDER: writes what the programs of frames of many kinds are made of besides kernels/, for compilers
// that read files: a folder a program with pass/KERNEL.h and whatever else is generated, and `program`, its file and
// defines as a command line has them. all.N.FILE has all kernels of a file that are compiled with the same defines,
// each as the first frame has it, N from 1; none/ has an empty interface for kernels that a program has no pass for.
#include "tests/product_programs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>

namespace {

namespace fs = std::filesystem;
using wedge::test::ProductProgram;

std::string commandOf(const ProductProgram& program)
{
    std::string command = program.source.file;
    for (const wedge::device::Defines* defines : { &program.options.defines, &program.source.defines }) {
        for (const auto& [name, value] : *defines) {
            command += fmt::format(" -D{}={}", name, value.empty() ? "1" : value);
        }
    }
    return command;
}

/// Everything of a program in one text, to tell it from others.
std::string contentsOf(const ProductProgram& program)
{
    std::string text = commandOf(program);
    for (const auto& [name, of] : program.source.generated) {
        text += fmt::format("\n{}\n{}", name, of);
    }
    return text;
}

void write(const fs::path& file, const std::string& text)
{
    fs::create_directories(file.parent_path());
    std::ofstream stream(file);
    stream << text << std::flush;
    if (!stream) {
        throw std::runtime_error("cannot write " + file.string());
    }
}

void write(const fs::path& folder, const ProductProgram& program)
{
    write(folder / "program", commandOf(program));
    for (const wedge::device::GeneratedSources* all : { &program.options.generated, &program.source.generated }) {
        for (const auto& [name, text] : *all) {
            write(folder / name, text);
        }
    }
}

} // namespace

int main(int count, char** arguments)
{
    if (count != 2) {
        std::fputs("kernel_programs: error: no folder: name it\n", stderr);
        return 2;
    }
    try {
        const fs::path folder = arguments[1];
        const wedge::device::Device device = wedge::device::Device::open("0");
        std::map<std::string, std::map<wedge::device::Defines, ProductProgram>> whole;
        wedge::test::everyProgram(device, [&](const ProductProgram& program) {
            std::string name = program.source.file;
            std::ranges::replace(name, '/', '.');
            write(folder / fmt::format("{:016x}.{}", std::hash<std::string>()(contentsOf(program)), name), program);
            auto& all = whole[name].emplace(program.source.defines, program).first->second.source.generated;
            for (const auto& [interface, text] : program.source.generated) {
                all.emplace(interface, text);
                write(folder / "none" / interface, "");
            }
            return true;
        });
        for (const auto& [name, programs] : whole) {
            unsigned number = 0;
            for (const auto& [defines, program] : programs) {
                write(folder / fmt::format("all.{}.{}", ++number, name), program);
            }
        }
    } catch (const std::exception& error) {
        fmt::print(stderr, "kernel_programs: {}\n", error.what());
        return 1;
    }
}
