// Messages stay one line that a terminal shows as it is, and of bounded length, whatever a file or a call put into
// them.
#include "host/error.h"
#include "host/text.h"

#include <doctest/doctest.h>

#include <string>

using namespace wedge;

TEST_CASE("plain text stays as it is")
{
    CHECK(printable("") == "");
    CHECK(printable("a/b c.toml:3") == "a/b c.toml:3");
    CHECK(printable("Gr\u00fc\u00dfe, \u65e5\u672c, \U0001f600") == "Gr\u00fc\u00dfe, \u65e5\u672c, \U0001f600");
}

TEST_CASE("what moves a terminal's cursor or changes its state is escaped")
{
    CHECK(printable("\x1b[2J") == "\\x1b[2J");
    CHECK(printable(std::string("a\0b", 3)) == "a\\x00b");
    CHECK(printable("a\nb\tc\rd\x7f") == "a\\nb\\tc\\x0dd\\x7f");
    CHECK(printable("\u009b2J") == "\\xc2\\x9b2J"); // C1: another escape
    CHECK(printable("\u202egnp.exe") == "\\xe2\\x80\\xaegnp.exe"); // turns the direction of writing
}

TEST_CASE("bytes that are not UTF-8 are escaped")
{
    CHECK(printable("\xff") == "\\xff");
    CHECK(printable("\xc0\x80") == "\\xc0\\x80"); // a longer form than needed
    CHECK(printable("\xed\xa0\x80") == "\\xed\\xa0\\x80"); // a surrogate
    CHECK(printable("\xf4\x90\x80\x80") == "\\xf4\\x90\\x80\\x80"); // beyond the last character
    CHECK(printable("\xe2\x82") == "\\xe2\\x82"); // cut
}

TEST_CASE("long text keeps its beginning and its end")
{
    CHECK(shortened("12345678", 8) == "12345678");
    CHECK(shortened("123456789", 8) == "12...789");
    const std::string letters(1000, 'x');
    CHECK(shortened(letters, 100).size() == 100);
    for (std::size_t most = 8; most < 40; ++most) {
        std::string umlauts;
        for (int i = 0; i < 50; ++i)
            umlauts += "\u00e4";
        const std::string cut = shortened(umlauts, most);
        CHECK(cut.size() <= most);
        CHECK(printable(cut) == cut); // no half characters
    }
}

TEST_CASE("messages are bounded, and the value gives way first")
{
    CHECK(std::string(Error("what", "value", "remedy").what()) == "what: value: remedy");
    const std::string huge(5'000'000, 'k');
    CHECK(std::string(Error("what", huge, "do this").what()).size() <= maxMessage);
    CHECK(std::string(Error(huge, huge, huge).what()).size() <= maxMessage);
    CHECK(std::string(Error(std::string(4000, '\x1b'), "v", huge).what()).size() <= maxMessage);
    const std::string text = Error("unknown key in the scene", huge, "leave it out").what();
    CHECK(text.starts_with("unknown key in the scene: kkk"));
    CHECK(text.ends_with("kkk: leave it out"));
    CHECK(text.find("...") != std::string::npos);
    CHECK(std::string(Error("a\nb", "c", "d").what()) == "a\\nb: c: d");
}
