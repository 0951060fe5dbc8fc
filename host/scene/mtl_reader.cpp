#include "host/scene/mtl_reader.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include <fmt/format.h>

#include "host/error.h"
#include "host/scene/mtl_texture.h"
#include "host/scene/paths.h"
#include "host/scene/statements.h"
#include "host/text.h"

namespace wedge::scene {
namespace {

constexpr std::uintmax_t maxMtlFile = std::uintmax_t { 256 } << 20;

/// What is written beside a texture without a colour of its own is what other programs take.
constexpr glm::vec3 diffuseOfTexture(0.6f);
/// The refractive index of what is no metal where no Ni above 1 is given: 4 % are reflected head-on.
constexpr float usualIndex = 1.5f;
/// Kd of mirrors and glass, at most, over what they reflect or let through.
constexpr float blackShare = 0.1f;

/// Statements that change the look in other programs, and what messages call them.
const std::map<std::string_view, const char*> unsupported = { { "disp", "displacement (disp)" },
    { "refl", "a reflection map (refl)" }, { "Ps", "sheen or clear coat (Ps, Pc)" },
    { "Pc", "sheen or clear coat (Ps, Pc)" }, { "map_Ps", "sheen or clear coat (Ps, Pc)" },
    { "map_Pm", "a texture of metal (map_Pm)" } };

/// Reads one library; a member reads one statement.
class Library {
public:
    Library(const std::filesystem::path& path, TextureSet& textures, Warnings& warnings)
        : where_("material file " + path.string())
        , folder_(path.parent_path())
        , warnings_(warnings)
        , textures_(textures)
    {
    }

    std::vector<Material> read(std::string_view text)
    {
        StatementReader statements(text);
        while (statements.next()) {
            const std::string_view keyword = statements.word();
            if (keyword == "newmtl")
                begin(statements.rest());
            else if (isOpen_)
                statement(keyword, statements);
        }
        end();
        if (materials_.empty())
            throw Error(where_ + " has no materials", "no line begins with newmtl and a name",
                "name a Wavefront material library");
        for (const auto& [what, left] : leftOut_)
            warnings_.add("statements of material files without effect",
                fmt::format("{}: {} has no effect here; {} material(s) have it, '{}' is the first", where_, what,
                    left.materials, left.first));
        warnOfEnergy(materials_, where_, warnings_);
        return std::move(materials_);
    }

private:
    /// What the statements of a material say besides what Material holds.
    struct Extra {
        bool hasDiffuse = false;
        int illumination = 2;
        bool hasDissolve = false; ///< d, which outdoes Tr
        std::optional<float> roughness, metal; ///< Pr, Pm
        float index = usualIndex; ///< Ni
        bool hasIndex = false; ///< above 1
        glm::vec3 filter { 1.0f }; ///< Tf
        MtlTexture diffuse, specular, exponent, emission, opacity, roughnessMap, normals, heights;
    };
    struct LeftOut {
        std::size_t materials = 0;
        std::string first;
        std::size_t last = 0; ///< number of the last material that was counted
    };

    void warn(std::string_view kind, const std::string& text)
    {
        warnings_.add(kind, fmt::format("{}: material '{}': {}", where_, shownName_, text));
    }

    void leaveOut(const std::string& what)
    {
        LeftOut& left = leftOut_[what];
        if (left.materials > 0 && left.last == materials_.size())
            return;
        if (left.materials++ == 0)
            left.first = material_.name;
        left.last = materials_.size();
    }

    void begin(std::string_view name)
    {
        end();
        isOpen_ = !name.empty();
        material_ = {};
        extra_ = {};
        material_.name = name;
        shownName_ = shortened(name, maxMessage / 3); // once, and not for each of its warnings
        material_.diffuse = glm::vec3(0.0f);
    }

    void statement(std::string_view keyword, StatementReader& in)
    {
        if (keyword == "Kd") {
            material_.diffuse = colour("Kd", in);
            extra_.hasDiffuse = true;
        } else if (keyword == "Ks")
            material_.specular = colour("Ks", in);
        else if (keyword == "Ke")
            material_.emission = colour("Ke", in);
        else if (keyword == "Ns")
            material_.exponent = number("Ns", in.word(), 1.0f);
        else if (keyword == "map_Kd")
            extra_.diffuse = parseMtlTexture(in);
        else if (keyword == "map_Ks")
            extra_.specular = parseMtlTexture(in);
        else if (keyword == "map_Ns")
            extra_.exponent = parseMtlTexture(in);
        else if (keyword == "map_Ke")
            extra_.emission = parseMtlTexture(in);
        else if (keyword == "map_d")
            extra_.opacity = parseMtlTexture(in);
        else if (keyword == "d" || keyword == "Tr")
            dissolve(keyword, in);
        else
            otherStatement(keyword, in);
    }

    void otherStatement(std::string_view keyword, StatementReader& in)
    {
        float value = 0.0f;
        if (keyword == "illum") {
            const bool isNumber = parseNumber(in.word(), value) == NumberKind::Good;
            extra_.illumination = isNumber && value >= 0.0f && value < 100.0f ? static_cast<int>(value) : 2;
        } else if (keyword == "Pr") {
            extra_.roughness = share("Pr", in.word(), 0.5f);
        } else if (keyword == "Pm") {
            extra_.metal = share("Pm", in.word(), 0.0f);
        } else if (keyword == "Ni") {
            value = number("Ni", in.word(), usualIndex);
            if (value > mostIndex) {
                warn("values of material files", fmt::format("Ni has the value {:g}, {:g} is used", value, usualIndex));
                value = usualIndex;
            }
            extra_.hasIndex = value > 1.0f;
            extra_.index = extra_.hasIndex ? value : usualIndex;
        } else if (keyword == "map_Pr") {
            extra_.roughnessMap = parseMtlTexture(in);
        } else if (keyword == "norm" || keyword == "map_Kn") {
            extra_.normals = parseMtlTexture(in);
        } else if (keyword == "bump" || keyword == "map_bump" || keyword == "map_Bump") {
            extra_.heights = parseMtlTexture(in);
        } else if (keyword == "Tf") {
            extra_.filter = colour("Tf", in);
        } else if (const auto known = unsupported.find(keyword); known != unsupported.end()) {
            leaveOut(known->second);
        }
    }

    /// d, or Tr = 1 - d where there is no d: some programs write Tr the other way round beside a d that is right.
    void dissolve(std::string_view keyword, StatementReader& in)
    {
        if (in.ahead() == "-halo") {
            leaveOut("transparency by the angle of view (d -halo)");
            return;
        }
        const bool isOpacity = keyword == "d";
        const float value = share(keyword, in.word(), isOpacity ? 1.0f : 0.0f);
        if (isOpacity || !extra_.hasDissolve)
            material_.opacity = isOpacity ? value : 1.0f - value;
        extra_.hasDissolve = extra_.hasDissolve || isOpacity;
    }

    /// A number in [0, 1]; another is told and replaced.
    float share(std::string_view key, std::string_view word, float replacement)
    {
        float value = 0.0f;
        if (parseNumber(word, value) == NumberKind::Good && value >= 0.0f && value <= 1.0f)
            return value;
        warn("values of material files", fmt::format("{} has the value {}, {:g} is used", key, word, replacement));
        return replacement;
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
            leaveOut("a texture of a mirror or glass (map_Ks)");
        m.specularModel = mirror ? SpecularModel::Mirror : SpecularModel::Glass;
        m.diffuse = glm::vec3(0.0f);
        m.specular = mirror ? m.specular : glm::vec3(1.0f);
        m.specularTexture = m.exponentTexture = -1;
        m.index = extra_.index;
        // The filter is of a whole body, which light passes into and out of.
        m.transmission = glm::sqrt(tf);
        return true;
    }

    /// A value that makes no sense is told and replaced.
    float number(const char* key, std::string_view word, float replacement)
    {
        float value = 0.0f;
        if (parseNumber(word, value) == NumberKind::Good && value >= 0.0f)
            return value;
        warn("values of material files", fmt::format("{} has the value {}, {:g} is used", key, word, replacement));
        return replacement;
    }

    /// One number stands for a grey, as the format has it.
    glm::vec3 colour(const char* key, StatementReader& in)
    {
        glm::vec3 value(number(key, in.word(), 0.0f));
        for (int i = 1; i < 3; ++i) {
            const std::string_view word = in.word();
            if (word.empty() || word.front() == '#')
                return value;
            value[i] = number(key, word, 0.0f);
        }
        return value;
    }

    /// A map of normals, or heights where there is none. What is named as heights may be a map of normals.
    void addNormals()
    {
        Material& m = material_;
        const bool mapped = !extra_.normals.name.empty();
        const MtlTexture& from = mapped ? extra_.normals : extra_.heights;
        if (mapped && !extra_.heights.name.empty())
            leaveOut("a bump map beside a normal map (bump, map_bump)");
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
        if (statement.hasUnsupported)
            warn("options of textures",
                fmt::format("the options -s, -o and -clamp of texture '{}' are not supported", statement.name));
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
        if (!extra_.hasDiffuse && !extra_.diffuse.name.empty())
            m.diffuse = diffuseOfTexture;
        if (m.diffuseTexture >= 0 && m.diffuse == glm::vec3(0.0f)) {
            warn("black colours beside textures", "Kd is black and would hide its texture, white is used");
            m.diffuse = glm::vec3(1.0f);
        }
        makeMetallicRough();
        addNormals();
        const bool isMirror = makeMirror(), shines = m.specular != glm::vec3(0.0f);
        if (!isMirror && extra_.illumination != 2 && (extra_.illumination != 1 || shines))
            leaveOut("an illumination model other than diffuse and highlight (illum)");
        if (m.specularModel != SpecularModel::Glass && extra_.filter != glm::vec3(1.0f))
            leaveOut("a transmission filter (Tf)");
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
    std::string shownName_; ///< its name in messages
    Extra extra_;
    std::map<std::string, LeftOut> leftOut_;
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
    const auto tooMuch = [&](const Material& m) { return reflected(m) > 1.0f + 1e-5f; };
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
