#include "host/scene/mtl_reader.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "host/error.h"
#include "host/scene/mtl_texture.h"
#include "host/scene/mtl_values.h"
#include "host/scene/paths.h"
#include "host/scene/statements.h"

namespace wedge::scene {
namespace {

constexpr std::uintmax_t maxMtlFile = std::uintmax_t { 256 } << 20;

/// What is written beside a texture without a colour of its own is what other programs take.
constexpr glm::vec3 diffuseOfTexture(0.6f);
/// The refractive index of what is no metal where no Ni above 1 is given: 4 % are reflected head-on.
constexpr float usualIndex = 1.5f;
/// Of unknown statements no more is shown.
constexpr std::size_t longestKeyword = 32;
/// Kd of mirrors and glass, at most, over what they reflect or let through.
constexpr float blackShare = 0.1f;

/// Statements that change the look in other programs, and what messages call them.
const std::map<std::string_view, const char*> unsupported = { { "disp", "displacement (disp)" },
    { "refl", "a reflection map (refl)" }, { "ps", "sheen or clear coat (Ps, Pc)" },
    { "pc", "sheen or clear coat (Ps, Pc)" }, { "map_ps", "sheen or clear coat (Ps, Pc)" },
    { "map_pm", "a texture of metal (map_Pm)" } };

/// Reads one library; a member reads one statement.
class Library {
public:
    Library(const std::filesystem::path& path, TextureSet& textures, Warnings& warnings)
        : where_("material file " + path.string())
        , folder_(path.parent_path())
        , warnings_(warnings)
        , textures_(textures)
        , notes_(where_, warnings)
        , values_(notes_)
    {
    }

    std::vector<Material> read(std::string_view text)
    {
        StatementReader statements(text);
        while (statements.next()) {
            const std::string keyword = lowerCase(std::string(statements.word().substr(0, longestKeyword)));
            if (keyword.empty() || keyword.front() == '#')
                continue;
            if (keyword == "newmtl")
                begin(unquoted(statements.rest()));
            else if (isOpen_)
                statement(keyword, statements);
            else if (lost_++ == 0)
                firstLost_ = statements.line();
        }
        end();
        if (materials_.empty())
            throw Error(where_ + " has no materials", "no line begins with newmtl and a name",
                "name a Wavefront material library");
        notes_.finish();
        if (lost_ > 0)
            warnings_.add("statements of material files without effect",
                fmt::format("{}:{}: a statement before any newmtl with a name has no effect; it is the first of {}",
                    where_, firstLost_, lost_));
        warnOfEnergy(materials_, where_, warnings_);
        return std::move(materials_);
    }

private:
    /// What the statements of a material say besides what Material holds.
    struct Extra {
        bool hasDiffuse = false, hasSpecular = false, hasEmission = false;
        int illumination = 2;
        bool hasDissolve = false; ///< d, which outdoes Tr
        std::optional<float> roughness, metal; ///< Pr, Pm
        float index = usualIndex; ///< Ni
        bool hasIndex = false; ///< above 1
        glm::vec3 filter { 1.0f }; ///< Tf
        MtlTexture diffuse, specular, exponent, emission, opacity, roughnessMap, normals, heights, ambient;
    };
    void warn(std::string_view kind, const std::string& text) { notes_.warn(kind, text); }

    void begin(std::string_view name)
    {
        end();
        isOpen_ = !name.empty();
        material_ = {};
        extra_ = {};
        material_.name = name;
        material_.diffuse = glm::vec3(0.0f);
        notes_.begin(name);
    }

    /// The texture that a statement names, if it is one of these. keyword: in small letters.
    MtlTexture* textureOf(std::string_view keyword)
    {
        const std::pair<std::string_view, MtlTexture*> known[] = { { "map_kd", &extra_.diffuse },
            { "map_ks", &extra_.specular }, { "map_ns", &extra_.exponent }, { "map_ke", &extra_.emission },
            { "map_d", &extra_.opacity }, { "map_pr", &extra_.roughnessMap }, { "norm", &extra_.normals },
            { "map_kn", &extra_.normals }, { "bump", &extra_.heights }, { "map_bump", &extra_.heights },
            { "map_ka", &extra_.ambient } };
        const auto found = std::ranges::find(known, keyword, &std::pair<std::string_view, MtlTexture*>::first);
        return found == std::end(known) ? nullptr : found->second;
    }

    /// Programs differ in the case of keywords. keyword: in small letters.
    void statement(std::string_view keyword, StatementReader& in)
    {
        if (MtlTexture* const texture = textureOf(keyword)) {
            *texture = parseMtlTexture(in);
            if (texture->name.empty())
                notes_.leaveOut(fmt::format("a {} without a file", keyword));
        } else if (keyword == "kd") {
            material_.diffuse = values_.colour("Kd", in, 0.5f);
            extra_.hasDiffuse = true;
        } else if (keyword == "ks") {
            material_.specular = values_.colour("Ks", in, 0.0f);
            extra_.hasSpecular = true;
        } else if (keyword == "ke") {
            material_.emission = values_.colour("Ke", in, 0.0f);
            extra_.hasEmission = true;
        } else if (keyword == "ns") {
            material_.exponent = values_.number("Ns", in.word(), 1.0f);
        } else if (keyword == "d" || keyword == "tr") {
            dissolve(keyword == "d" ? "d" : "Tr", in);
        } else {
            otherStatement(keyword, in);
        }
    }

    void otherStatement(std::string_view keyword, StatementReader& in)
    {
        if (keyword == "illum") {
            extra_.illumination = static_cast<int>(std::min(values_.number("illum", in.word(), 2.0f), 100.0f));
        } else if (keyword == "pr") {
            extra_.roughness = values_.share("Pr", in.word(), 0.5f);
        } else if (keyword == "pm") {
            extra_.metal = values_.share("Pm", in.word(), 0.0f);
        } else if (keyword == "ni") {
            index(in.word());
        } else if (keyword == "tf") {
            extra_.filter = values_.colour("Tf", in, 1.0f);
        } else if (const auto known = unsupported.find(keyword); known != unsupported.end()) {
            notes_.leaveOut(known->second);
        } else if (keyword != "ka") { // light from everywhere, which is worked out here and not stated
            notes_.leaveOut(fmt::format("statement '{}'", keyword));
        }
    }

    void index(std::string_view word)
    {
        float value = values_.number("Ni", word, usualIndex);
        if (value > mostIndex) {
            warn("values of material files", fmt::format("Ni has the value {:g}, {:g} is used", value, usualIndex));
            value = usualIndex;
        }
        extra_.hasIndex = value > 1.0f;
        extra_.index = extra_.hasIndex ? value : usualIndex;
    }

    /// A texture is seen without a colour of its own, as far as it leaves light for others; beside a black one it is
    /// not, which is told.
    void completeTextures()
    {
        Material& m = material_;
        if (!extra_.hasDiffuse && !extra_.diffuse.name.empty())
            m.diffuse = diffuseOfTexture;
        if (m.diffuseTexture >= 0 && m.diffuse == glm::vec3(0.0f)) {
            warn("black colours beside textures", "Kd is black and would hide its texture, white is used");
            m.diffuse = glm::vec3(1.0f);
        }
        if (m.emissionTexture >= 0 && !extra_.hasEmission)
            m.emission = glm::vec3(1.0f);
        if (m.specularTexture >= 0 && !extra_.hasSpecular)
            m.specular = glm::vec3(std::max(0.0f, 1.0f - std::max({ m.diffuse.x, m.diffuse.y, m.diffuse.z })));
        if (m.emissionTexture >= 0 && m.emission == glm::vec3(0.0f))
            notes_.leaveOut("a map_Ke beside a black Ke");
        const bool isRough = extra_.roughness || extra_.metal || !extra_.roughnessMap.name.empty();
        const bool shines = m.specular != glm::vec3(0.0f);
        if (isRough && (shines || m.specularTexture >= 0 || m.exponentTexture >= 0))
            notes_.leaveOut("Ks and its textures beside Pr, Pm or map_Pr");
        if (m.specularTexture >= 0 && !shines && !isRough)
            notes_.leaveOut(extra_.hasSpecular ? "a map_Ks beside a black Ks" : "a map_Ks beside a white Kd");
        if (m.exponentTexture >= 0 && !shines && !isRough)
            notes_.leaveOut("a map_Ns without Ks");
        if (!extra_.ambient.name.empty() && extra_.diffuse.name.empty())
            notes_.leaveOut("a map_Ka without map_Kd");
    }

    /// d, or Tr = 1 - d where there is no d: some programs write Tr the other way round beside a d that is right.
    void dissolve(std::string_view keyword, StatementReader& in)
    {
        if (in.ahead() == "-halo") {
            notes_.leaveOut("transparency by the angle of view (d -halo)");
            return;
        }
        const bool isOpacity = keyword == "d";
        const float value = values_.share(keyword, in.word(), isOpacity ? 1.0f : 0.0f);
        if (isOpacity || !extra_.hasDissolve)
            material_.opacity = isOpacity ? value : 1.0f - value;
        extra_.hasDissolve = extra_.hasDissolve || isOpacity;
    }

    /// Kd, Ni and Pm to what is reflected: a metal's colour is its reflection's, another's what is below it.
    void makeMetallicRough()
    {
        Material& m = material_;
        const bool textured = !extra_.roughnessMap.name.empty();
        if (!extra_.roughness && !extra_.metal && !textured)
            return;
        m.specularModel = SpecularModel::Ggx;
        m.roughness = extra_.roughness.value_or(textured ? 1.0f : m.roughness);
        m.exponentTexture = texture(extra_.roughnessMap, decode::TextureUse::Numbers);
        const float metal = extra_.metal.value_or(0.0f), ratio = (extra_.index - 1.0f) / (extra_.index + 1.0f);
        const glm::vec3 base = m.diffuse;
        m.specular = glm::mix(glm::vec3(ratio * ratio), base, metal);
        m.diffuse = base * (1.0f - metal) * (1.0f - ratio * ratio);
        // One texture multiplies each colour: a mixture counts as what there is more of.
        m.specularTexture = metal >= 0.5f ? m.diffuseTexture : -1;
    }

    /// Whether Kd is next to nothing beside another colour.
    bool isBlackBeside(float other) const
    {
        const glm::vec3& kd = material_.diffuse;
        return extra_.diffuse.name.empty() && std::max({ kd.x, kd.y, kd.z }) <= blackShare * other;
    }

    /// A mirror or glass, where illum says so and the rest of the material is of one: programs write it for much else.
    /// Returns whether it is.
    bool makeMirror()
    {
        Material& m = material_;
        const int illum = extra_.illumination;
        const float shine = std::max({ m.specular.x, m.specular.y, m.specular.z });
        const glm::vec3& tf = extra_.filter;
        const bool mirror = (illum == 3 || illum == 5) && shine > 0.0f && isBlackBeside(shine);
        const bool glass = (illum == 4 || illum == 6 || illum == 7 || illum == 9) && extra_.hasIndex
            && m.opacity == 1.0f && extra_.opacity.name.empty() && isBlackBeside(std::max({ shine, tf.x, tf.y, tf.z }));
        if (m.specularModel == SpecularModel::Ggx || !(mirror || glass))
            return false;
        if (m.specularTexture >= 0)
            notes_.leaveOut("a texture of a mirror or glass (map_Ks)");
        m.specularModel = mirror ? SpecularModel::Mirror : SpecularModel::Glass;
        m.diffuse = glm::vec3(0.0f);
        m.specular = mirror ? m.specular : glm::vec3(1.0f);
        m.specularTexture = m.exponentTexture = -1;
        m.index = extra_.index;
        // The filter is of a whole body, which light passes into and out of.
        m.transmission = glm::sqrt(tf);
        return true;
    }

    /// A map of normals, or heights where there is none. What is named as heights may be a map of normals.
    void addNormals()
    {
        Material& m = material_;
        const bool mapped = !extra_.normals.name.empty();
        const MtlTexture& from = mapped ? extra_.normals : extra_.heights;
        if (mapped && !extra_.heights.name.empty())
            notes_.leaveOut("a bump map beside a normal map (bump, map_bump)");
        m.normalTexture = texture(from, decode::TextureUse::Numbers, "the surface stays smooth");
        m.normalIsHeight = !mapped && m.normalTexture >= 0 && !looksLikeNormals(textures_.at(m.normalTexture));
        if (from.multiplier.empty())
            return;
        float value = 1.0f;
        if (parseNumber(from.multiplier, value) != NumberKind::Good || std::abs(value) > mostNormalStrength) {
            value = 1.0f;
            warn("values of material files", fmt::format("-bm has the value {}, 1 is used", from.multiplier));
        }
        m.normalStrength = value;
    }

    int texture(const MtlTexture& statement, decode::TextureUse use = decode::TextureUse::Colours,
        const char* instead = "the plain colour is used")
    {
        if (statement.name.empty())
            return -1;
        if (!statement.unsupported.empty())
            warn("options of textures",
                fmt::format("the option {} of texture '{}' has no effect here", statement.unsupported, statement.name));
        try {
            return textures_.add(resolvePath(statement.name, folder_, where_), use);
        } catch (const Error& error) {
            warn("textures that cannot be used", fmt::format("{}; {}", error.what(), instead));
            return -1;
        }
    }

    void end()
    {
        if (!isOpen_)
            return;
        Material& m = material_;
        m.diffuseTexture = texture(extra_.diffuse);
        m.specularTexture = texture(extra_.specular);
        m.exponentTexture = texture(extra_.exponent, decode::TextureUse::Numbers);
        m.emissionTexture = texture(extra_.emission);
        m.opacityTexture = texture(extra_.opacity, decode::TextureUse::Numbers);
        completeTextures();
        makeMetallicRough();
        addNormals();
        const bool isMirror = makeMirror(), shines = m.specular != glm::vec3(0.0f);
        if (!isMirror && extra_.illumination != 2 && (extra_.illumination != 1 || shines))
            notes_.leaveOut("an illumination model other than diffuse and highlight (illum)");
        if (m.specularModel != SpecularModel::Glass && extra_.filter != glm::vec3(1.0f))
            notes_.leaveOut("a transmission filter (Tf)");
        materials_.push_back(m);
        isOpen_ = false;
    }

    const std::string where_;
    const std::filesystem::path folder_;
    Warnings& warnings_;
    TextureSet& textures_;
    std::vector<Material> materials_;
    bool isOpen_ = false; ///< material_ and extra_ are being read
    Material material_;
    Extra extra_;
    MtlNotes notes_;
    MtlValues values_;
    std::size_t lost_ = 0, firstLost_ = 0; ///< statements that no material has, and the first one's line
};

} // namespace

std::vector<Material> readMtl(const std::filesystem::path& path, TextureSet& textures, Warnings& warnings)
{
    return parseMtl(readFile(path, "material file", maxMtlFile), path, textures, warnings);
}

std::vector<Material> parseMtl(
    std::string_view text, const std::filesystem::path& path, TextureSet& textures, Warnings& warnings)
{
    if (text.find('\0') != std::string_view::npos)
        throw Error("material file " + path.string() + " holds binary data", "a byte of value 0",
            "name a Wavefront material library");
    return Library(path, textures, warnings).read(text);
}

void warnOfEnergy(const std::vector<Material>& materials, const std::string& where, Warnings& warnings)
{
    const auto reflected = [](const Material& m) {
        glm::vec3 sum = m.diffuse + m.specular;
        if (m.specularModel == SpecularModel::Glass)
            sum = glm::max(m.specular, m.transmission);
        return std::max({ sum.x, sum.y, sum.z });
    };
    const auto tooMuch = [&](const Material& m) { return reflected(m) > 1.0f + 1e-3f; };
    const auto count = std::count_if(materials.begin(), materials.end(), tooMuch);
    if (count == 0)
        return;
    const auto worst = std::max_element(materials.begin(), materials.end(),
        [&](const Material& a, const Material& b) { return reflected(a) < reflected(b); });
    warnings.add("materials that reflect more light than they get",
        fmt::format("{}: {} material(s) reflect more light than they get; diffuse + specular of '{}' reaches {:.3g}",
            where, count, worst->name, reflected(*worst)));
}

} // namespace wedge::scene
