// [[light.style]]: how hard shadows are drawn, and what is wrong in it.
#include "host/scene/sequence.h"
#include "tests/scene_support.h"

#include <doctest/doctest.h>

namespace {

using wedge::scene::Scene;

const std::string sun = "[[light]]\ntype = 'directional'\nname = 'sun'\ndirection = [0, -1, 0]\nirradiance = 1\n";

Scene load(const std::string& text)
{
    const scene_test::TemporaryFolder folder;
    return wedge::scene::loadScene(folder.write("s.toml", text));
}

/// What is said of a scene with that style of its sun.
std::string refused(const std::string& style)
{
    const scene_test::TemporaryFolder folder;
    return scene_test::errorOf(folder.write("s.toml", sun + style));
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

} // namespace

TEST_CASE("styles of shadows: defaults, numbers, colours, several that share a light")
{
    const Scene one = load(sun + "[[light.style]]\ninflation = 2\n");
    REQUIRE(one.directionalLights.size() == 1);
    CHECK(one.directionalLights[0].name == "sun");
    REQUIRE(one.directionalLights[0].styles.size() == 1);
    wedge::scene::ShadowStyle inflated;
    inflated.inflation = 2;
    CHECK(one.directionalLights[0].styles[0] == inflated);
    const Scene two = load("[[light]]\ntype = 'point'\nposition = [0, 1, 0]\nintensity = 1\n"
                           "[[light.style]]\nweight = 0.25\ninflation = -0.5\nsoftness = 0.125\nabstraction = 2\n"
                           "brightness = [0, 0.5, 1]\nkeep_area = false\n"
                           "[[light.style]]\nweight = 0.75005\nbrightness = 0.5\n");
    REQUIRE(two.pointLights.size() == 1);
    REQUIRE(two.pointLights[0].styles.size() == 2);
    CHECK(two.pointLights[0].styles[0]
        == wedge::scene::ShadowStyle { 0.25f, -0.5f, 0.125f, 2.0f, glm::vec3(0, 0.5f, 1), 1.0f, false, {}, {}, {} });
    CHECK(two.pointLights[0].styles[1].brightness == wedge::scene::Knob<glm::vec3>(glm::vec3(0.5f)));
    // What changes nothing is none.
    CHECK(load(sun).directionalLights[0].styles.empty());
    CHECK(load(sun + "[[light.style]]\nkeep_area = false\n").directionalLights[0].styles.empty());
    CHECK(load(sun + "[[light.style]]\nweight = 0.5\n[[light.style]]\nweight = 0.5\n")
              .directionalLights[0]
              .styles.empty());
}

TEST_CASE("knobs that go by how far away what throws the shadow is")
{
    using wedge::scene::Knob;
    const Scene scene = load(sun
        + "[[light.style]]\ninflation = { at = [0.5, -0.25, 2] }\nsoftness = { at = [-1, 0, 3] }\n"
          "abstraction = { at = [0.5, 0, 0] }\nbrightness = { at = [0, 0.5, -0.25] }\n");
    const wedge::scene::ShadowStyle& style = scene.directionalLights[0].styles.at(0);
    CHECK(style.inflation == Knob<float>(0.5f, -0.25f, 2));
    CHECK(style.softness == Knob<float>(-1, 0, 3));
    CHECK(style.abstraction == Knob<float>(0.5f));
    CHECK_FALSE(style.abstraction.varies());
    CHECK(style.brightness == Knob<glm::vec3>(glm::vec3(0), glm::vec3(0.5f), glm::vec3(-0.25f)));
    const Scene tinted = load(sun + "[[light.style]]\nbrightness = { at = [[0, 0.5, 1], [1, 2, 3], [-1, 0, 1]] }\n");
    CHECK(tinted.directionalLights[0].styles.at(0).brightness
        == Knob<glm::vec3>(glm::vec3(0, 0.5f, 1), glm::vec3(1, 2, 3), glm::vec3(-1, 0, 1)));
    CHECK(load(sun + "[[light.style]]\ninflation = { at = [0, 0, 0] }\n").directionalLights[0].styles.empty());
    CHECK(load(sun + "[[light.style]]\ninflation = { at = [0, 0, 1] }\n").directionalLights[0].styles.size() == 1);
}

TEST_CASE("objects that throw shadows in a style, and that have them, go by their names")
{
    const scene_test::TemporaryFolder folder;
    folder.write("tri.obj", "o tri\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const std::string meshes = "[[mesh]]\nname = 'tree'\nfile = 'tri.obj'\ninstances = [{ name = 'low' }, { name = "
                               "'high' }]\n[[mesh]]\nname = 'ground'\nfile = 'tri.obj'\n";
    const auto styled = [&](const std::string& lists) {
        return folder.write("s.toml", meshes + sun + "[[light.style]]\ninflation = 1\n" + lists);
    };
    const Scene scene = wedge::scene::loadScene(styled("casters = ['tree/low', 'ground/tri']\nreceivers = 'tree'\n"));
    const wedge::scene::ShadowStyle& style = scene.directionalLights[0].styles.at(0);
    CHECK(style.casters == std::vector<std::string> { "ground/tri", "tree/low" });
    CHECK(style.receivers == std::vector<std::string> { "tree" });
    const auto says = [&](const std::string& lists, const std::string& what) {
        const std::string message = scene_test::errorOf(styled(lists));
        CHECK_MESSAGE(contains(message, what), message);
    };
    // Each group of casters has all of the light.
    const std::string high = "casters = 'tree/high'\n", more = "[[light.style]]\ninflation = 2\n";
    CHECK(
        wedge::scene::loadScene(styled(high + more + "casters = 'ground'\n" + more)).directionalLights[0].styles.size()
        == 3);
    CHECK(wedge::scene::loadScene(styled(high + "weight = 0.25\n" + more + more + "weight = 0.75\n" + high))
              .directionalLights[0]
              .styles.size()
        == 3);
    // By what they name, in whatever order and however often.
    const std::string some = "weight = 0.5\ncasters = ['tree/high', 'ground']\n";
    const std::string same = "weight = 0.5\ncasters = ['ground', 'tree/high', 'ground']\n";
    CHECK(wedge::scene::loadScene(styled(some + more + same)).directionalLights[0].styles.at(1).casters
        == std::vector<std::string> { "ground", "tree/high" });
    const std::string twice = "style of light has an object among the casters of two lists: ";
    says(high + more + "casters = 'tree'\n", twice + "'tree/high/tri'");
    says("casters = 'ground/tri'\n" + more + "casters = ['tree', 'ground']\n", twice + "'ground/tri'");
    says(high + more + "weight = 0.5\n", "style of light has weights that do not add up to 1: 0.5");
    says(high + more + high, "light.style lacks a key: weight");
    says("casters = 'tre'\n", "casters of light.style names no object of the scene: 'tre': did you mean 'tree'?");
    says("receivers = ['tree', 'tree/lo']\n", "names no object of the scene: 'tree/lo': did you mean 'tree/low'?");
    says("receivers = 'lighthouse'\n", "names no object of the scene: 'lighthouse': wedge info lists the objects");
    says("casters = []\n", "casters of light.style is empty");
    says("casters = 3\n", "casters of light.style must be a name, or a list of names");
}

TEST_CASE("keys change a style over time: in between linearly, before and after them not")
{
    const scene_test::TemporaryFolder folder;
    const std::string text = sun
        + "[[light.style]]\nsoftness = 0.25\nkey = [{ time = 1, inflation = 1, brightness = [0, 0.5, 1] }, "
          "{ time = 3, inflation = -1, softness = 0.75, abstraction = 2 }]\n";
    wedge::scene::Sequence sequence(folder.write("s.toml", text));
    const Scene scene = sequence.takeScene();
    const auto styleAt = [&](double time) {
        const auto styles = sequence.at(time).directionalLights.at(0).styles;
        REQUIRE(styles.size() == 1);
        return styles[0];
    };
    using wedge::scene::Knob;
    CHECK(scene.directionalLights.at(0).styles.at(0) == styleAt(0));
    for (const double before : { 0.0, 1.0 }) {
        CHECK(styleAt(before).inflation == Knob(1.0f));
        CHECK(styleAt(before).softness == Knob(0.25f)); // the style's own
        CHECK(styleAt(before).abstraction == Knob(0.0f));
        CHECK(styleAt(before).brightness == Knob(glm::vec3(0, 0.5f, 1)));
    }
    CHECK(styleAt(1.5).inflation == Knob(0.5f));
    CHECK(styleAt(1.5).softness == Knob(0.375f));
    CHECK(styleAt(1.5).abstraction == Knob(0.5f));
    CHECK(styleAt(1.5).brightness == Knob(glm::vec3(0, 0.375f, 0.75f)));
    for (const double after : { 3.0, 4.0 }) {
        CHECK(styleAt(after).inflation == Knob(-1.0f));
        CHECK(styleAt(after).brightness == Knob(glm::vec3(0.0f)));
    }
    // All moments know all keys.
    REQUIRE(styleAt(0).keys.size() == 2);
    CHECK(styleAt(0).keys[1] == styleAt(7).keys[1]);
    CHECK(styleAt(0).keys[1].abstraction == Knob(2.0f));
    // One that is as none at a time is still there.
    const Scene none = load(sun + "[[light.style]]\nkey = [{ time = 0 }, { time = 1, softness = 1 }]\n");
    CHECK(none.directionalLights[0].styles.size() == 1);
}

TEST_CASE("a scene knows whether styles alone have keys, and moments whether knobs alone differ")
{
    const std::string keys = "[[light.style]]\nsoftness = 1\nkey = [{ time = 0 }, { time = 1, softness = 2 }]\n";
    const std::string camera = "[camera]\neye = [0, 1, 4]\nlook_at = [0, 0, 0]\n";
    const std::string moves = "key = [{ time = 0 }, { time = 1, eye = [0, 1, 5] }]\n";
    CHECK(load(camera + sun + keys).onlyStylesChange);
    CHECK_FALSE(load(camera + sun + "[[light.style]]\nsoftness = 1\n").onlyStylesChange);
    CHECK_FALSE(load(camera + moves + sun + keys).onlyStylesChange);
    CHECK_FALSE(
        load(camera + sun + "key = [{ time = 0 }, { time = 1, rotate = [0, 0, 1, 9] }]\n" + keys).onlyStylesChange);
    // Of soft shadows likewise.
    const std::string quad =
        "[[light]]\ntype = 'quad'\ncentre = [0, 4, 0]\nhalf_u = [1, 0, 0]\nhalf_v = [0, 0, 1]\nradiance = 5\n";
    CHECK(load(camera + quad + keys).onlyStylesChange);
    CHECK(load(camera + sun + keys + quad + keys).onlyStylesChange);
    CHECK_FALSE(load(camera + quad + "[[light.style]]\nsoftness = 1\n").onlyStylesChange);
    CHECK(load(camera + sun + keys + quad + "[[light.style]]\nsoftness = 1\n").onlyStylesChange);
    const auto changeOf = [](const std::string& text, double from, double to) {
        const scene_test::TemporaryFolder folder;
        wedge::scene::Sequence sequence(folder.write("s.toml", text));
        Scene scene = sequence.takeScene();
        wedge::scene::Moment first = sequence.at(from), second = sequence.at(to);
        const wedge::scene::Change toFirst = wedge::scene::changeTo(first, scene);
        wedge::scene::apply(std::move(first), toFirst, scene);
        const wedge::scene::Change change = wedge::scene::changeTo(second, scene);
        const bool hard = !scene.directionalLights.empty();
        const auto styles = hard ? second.directionalLights.at(0).styles : second.areaLights.at(0).styles;
        wedge::scene::apply(std::move(second), change, scene);
        CHECK((hard ? scene.directionalLights.at(0).styles : scene.areaLights.at(0).styles) == styles);
        return change;
    };
    CHECK(changeOf(camera + sun + keys, 0, 0.5).onlyKnobs);
    CHECK_FALSE(changeOf(camera + sun + keys, 0, 0.5).lights);
    CHECK_FALSE(changeOf(camera + moves + sun + keys, 0, 0.5).onlyKnobs);
    const std::string turns = "key = [{ time = 0 }, { time = 1, rotate = [0, 0, 1, 9] }]\n";
    CHECK_FALSE(changeOf(camera + sun + turns + keys, 0, 0.5).onlyKnobs);
    CHECK(changeOf(camera + sun + turns + keys, 0, 0.5).lights);
    CHECK(changeOf(camera + quad + keys, 0, 0.5).onlyKnobs);
    CHECK_FALSE(changeOf(camera + quad + keys, 0, 0.5).lights);
    // Another penumbra: other level sets.
    const std::string narrows = "[[light.style]]\nkey = [{ time = 0 }, { time = 1 , penumbra = 0.5 }]\n";
    CHECK_FALSE(changeOf(camera + quad + narrows, 0, 0.5).onlyKnobs);
    CHECK_FALSE(changeOf(camera + quad + narrows, 0, 0.5).lights);
    // A blur comes or goes: other passes.
    const std::string blurs = "[[light.style]]\nkey = [{ time = 0 }, { time = 1 , abstraction = 1 }]\n";
    CHECK_FALSE(changeOf(camera + sun + blurs, 0, 0.5).onlyKnobs);
    CHECK(changeOf(camera + sun + blurs, 0.5, 0.75).onlyKnobs);
}

TEST_CASE("what is wrong in a style is told with its place")
{
    const auto says = [](const std::string& style, const std::string& what) {
        const std::string message = refused(style);
        CHECK_MESSAGE(contains(message, what), message);
    };
    const std::string style = "[[light.style]]\n";
    says(style + "inflaton = 1\n", "s.toml:7:1: unknown key in light.style: 'inflaton': did you mean 'inflation'?");
    says(style + "softness = -0.1\n", "s.toml:7:12: softness of light.style is out of range: -0.1");
    says(style + "abstraction = -1\n", "abstraction of light.style is out of range");
    says(style + "inflation = nan\n", "inflation of light.style is not finite");
    says(style + "softness = inf\n", "softness of light.style is not finite");
    says(style + "brightness = 1.5\n", "brightness of light.style is out of range: 1.5: use 0 to 1");
    says(style + "brightness = [0, -1, 0]\n", "brightness of light.style is negative");
    says(style + "keep_area = 1\n", "keep_area of light.style must be true or false");
    says(style + "weight = 0.9\n", "style of light has weights that do not add up to 1: 0.9");
    says(
        style + "weight = 0.5\n" + style + "weight = 0.4\n", "style of light has weights that do not add up to 1: 0.9");
    says(style + "weight = 0.5\n" + style + "inflation = 1\n", "light.style lacks a key: weight");
    says(style + "key = [{ inflation = 1 }]\n", "light.style.key lacks a key: time");
    says(style + "key = [{ time = 1 }, { time = 0 }]\n",
        "time of light.style.key is not after that of the key before: 1 and 0");
    says(style + "key = [{ time = 1 }, { time = 1 }]\n", "is not after that of the key before: 1 and 1");
    says(style + "key = [{ time = nan }]\n", "time of light.style.key is not finite");
    says(style + "key = [{ time = 0, inflation = nan }]\n", "inflation of light.style.key is not finite");
    says(style + "key = [{ time = 0, softness = -1 }]\n", "softness of light.style.key is out of range: -1");
    says(style + "key = [{ time = 0, brightness = 2 }]\n", "brightness of light.style.key is out of range: 2");
    says(style + "key = [{ time = 0, weight = 1 }]\n", "unknown key in light.style.key: 'weight'");
    says("style = 1\n", "style of light must be a table");
    says(style + "inflation = { at = [1, 2] }\n", "s.toml:7:20: at of light.style.inflation must have 3 numbers");
    says(style + "softness = { at = [1, 2, 3, 4] }\n", "at of light.style.softness must have 3 numbers");
    says(style + "softness = { at = [1, nan, 3] }\n", "at of light.style.softness is not finite");
    says(style + "inflation = { at = [0, 1e13, 0] }\n", "at of light.style.inflation is out of range: 1e+13");
    says(style + "inflation = { to = [0, 1, 0] }\n", "light.style.inflation lacks a key: at");
    says(style + "inflation = { at = [0, 1, 0], key = 1 }\n", "unknown key in light.style.inflation: 'key'");
    says(style + "softness = { at = [-1, 0, 0] }\n", "softness of light.style is out of range: -1");
    says(style + "brightness = { at = [0, 1, 0, 1] }\n",
        "at of light.style.brightness must have three numbers or three colours: 4 numbers");
    says(style + "brightness = { at = [-0.5, 0, 0] }\n", "brightness of light.style is out of range: -0.5");
    const std::string alike = " must be one list of numbers, or several of as many each: ";
    says(style + "brightness = { at = [[0.25, 0.5, 0.75]] }\n",
        "at of light.style.brightness" + alike + "[ [ 0.25, 0.5, 0.75 ] ]");
    says(style + "brightness = { at = [[1], [2, 3], [4, 5, 6, 7, 8, 9]] }\n", alike);
    says(style + "brightness = { at = [[1, 2, 3], 4, 5, 6, [7, 8, 9]] }\n", alike);
    says(style + "inflation = { at = [[0], [1], [0]] }\n", "at of light.style.inflation" + alike);
    says(style + "weight = { at = [1, 0, 0] }\n", "weight of light.style must be a number");
    const scene_test::TemporaryFolder folder;
    const auto saysOfQuad = [&](const std::string& more, const std::string& expected) {
        const std::string quad = scene_test::errorOf(folder.write("s.toml",
            "[[light]]\ntype = 'quad'\ncentre = [0, 4, 0]\nhalf_u = [1, 0, 0]\nhalf_v = [0, 0, 1]\nradiance = 5\n"
                + style + more));
        CHECK_MESSAGE(contains(quad, expected), quad);
    };
    says(style + "penumbra = 0.5\n",
        "penumbra of light.style is of soft shadows, and those of this light are hard: 0.5");
    saysOfQuad("penumbra = 2\n", "penumbra of light.style is out of range: 2");
    saysOfQuad("casters = 'a'\n", "casters of light.style are of hard shadows, and those of a quad are soft: 'a'");
    saysOfQuad("softness = { at = [1, 1, 0] }\n", "softness of light.style goes by what throws the shadow");
    saysOfQuad("key = [{ time = 0, brightness = { at = [0, 1, 0] } }]\n",
        "brightness of light.style.key goes by what throws the shadow");
}
