// The program with the sky: `wedge render` and all else of the command line.
#include "tests/effects/constant_sky/constant_sky.h"

namespace {

const bool registered = [] {
    wedge::test::registerSky();
    return true;
}();

} // namespace
