#include "host/decode/bmp.h"
#include "tests/fuzz/decode_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    return decodeForFuzzing(data, size, wedge::decode::decodeBmp);
}
