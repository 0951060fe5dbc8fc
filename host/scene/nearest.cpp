#include "host/scene/nearest.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include "host/scene/paths.h"

namespace wedge::scene {
namespace {

constexpr std::size_t longestWord = 64; // the edit distance takes quadratic time

/// Number of letters to insert, delete or replace to turn a into b (Levenshtein).
std::size_t editDistance(const std::string& a, const std::string& b)
{
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t { 0 });
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i + 1;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({ replaced, row[j] + 1, row[j + 1] + 1 });
        }
    }
    return row.back();
}

std::string lettersOnly(std::string text)
{
    std::erase_if(text, [](char c) { return c == '_' || c == '-'; });
    return lowerCase(text);
}

} // namespace

std::string nearest(const std::string& word, const std::set<std::string>& candidates)
{
    if (word.size() > longestWord)
        return "";
    const std::string plain = lettersOnly(word);
    std::string best;
    std::size_t bestDistance = plain.size() / 3 + 1;
    for (const std::string& candidate : candidates) {
        if (candidate.size() > longestWord)
            continue;
        const std::size_t distance = editDistance(plain, lettersOnly(candidate));
        if (distance <= bestDistance && (best.empty() || distance < bestDistance)) {
            best = candidate;
            bestDistance = distance;
        }
    }
    return best;
}

} // namespace wedge::scene
