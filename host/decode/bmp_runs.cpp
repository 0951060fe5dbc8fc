#include "host/decode/bmp_runs.h"

namespace wedge::decode {

namespace {

class RunDecoder {
public:
    RunDecoder(ByteReader& in, unsigned bits, std::span<const std::uint32_t> palette, Picture& picture)
        : in_(in)
        , bits_(bits)
        , palette_(palette)
        , picture_(picture)
    {
    }

    void decode()
    {
        for (;;) {
            const unsigned count = in_.byte();
            const std::uint8_t value = in_.byte();
            if (count > 0) {
                const std::uint8_t repeated[] = { value };
                put(count, repeated);
            } else if (value == 0) { // end of the row
                x_ = 0;
                ++y_;
            } else if (value == 1) { // end of the picture
                return;
            } else if (value == 2) { // move
                x_ += in_.byte();
                y_ += in_.byte();
            } else { // pixels one by one, padded to an even number of bytes
                const std::size_t bytes = bits_ == 8 ? value : (value + 1u) / 2;
                put(value, in_.take(bytes));
                in_.take(bytes % 2);
            }
        }
    }

private:
    /// Puts so many pixels, from the values over and over.
    void put(unsigned count, Bytes values)
    {
        const Size size = picture_.size;
        if (y_ >= static_cast<unsigned>(size.height) || count > static_cast<unsigned>(size.width)
            || x_ > static_cast<unsigned>(size.width) - count)
            throw Failure("a run of pixels goes beyond its row");
        std::uint32_t* row = picture_.rowFromBottom(static_cast<int>(y_)) + x_;
        x_ += count;
        for (unsigned i = 0; i < count; ++i) {
            const std::uint8_t value = values[(bits_ == 8 ? i : i / 2) % values.size()];
            const unsigned index = bits_ == 8 ? value : (i % 2 == 0 ? value >> 4 : value & 15);
            if (index >= palette_.size())
                throw Failure("a pixel has a colour that its palette lacks");
            row[i] = palette_[index];
        }
    }

    ByteReader& in_;
    unsigned bits_;
    std::span<const std::uint32_t> palette_;
    Picture& picture_;
    std::size_t x_ = 0, y_ = 0;
};

} // namespace

void decodeBmpRuns(ByteReader& in, unsigned bits, std::span<const std::uint32_t> palette, Picture& picture)
{
    RunDecoder(in, bits, palette, picture).decode();
}

} // namespace wedge::decode
