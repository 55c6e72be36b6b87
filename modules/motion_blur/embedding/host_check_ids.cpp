// SPDX-License-Identifier: MIT
// What a host's ids say of its movers, and whether they last.
#include "modules/motion_blur/embedding/host_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <unordered_map>
#include <vector>

namespace shutter::motion_blur {

namespace {

using math::dvec2;

std::vector<bool> findSeenRows(const shader::CheckTotals& totals, uint32_t rowCount) {
    std::vector<bool> seen(std::min(rowCount, shader::kCheckRows));
    for (uint32_t row = 0; row < seen.size(); ++row)
        seen[row] = (totals.seenRows[row / 32] >> (row % 32) & 1u) != 0;
    return seen;
}

void checkListedMovers(const CheckedFrame& now, std::vector<Finding>& findings) {
    const CheckFacts& facts = now.facts;
    const std::vector<bool> seen = findSeenRows(now.totals, facts.rowCount);
    uint32_t inView = 0;
    bool anySeen = false;
    for (const CheckFacts::Mover& mover : facts.movers) {
        if (mover.row >= seen.size())
            return; // beyond what is looked for
        anySeen = anySeen || seen[mover.row];
        inView += mover.isInView && !seen[mover.row];
    }
    if (anySeen || inView == 0)
        return;
    std::string rows;
    for (uint32_t row = 0, listed = 0; row < seen.size() && listed < 4; ++row)
        if (seen[row]) {
            rows += fmt::format("{}{}", listed == 0 ? "" : ", ", row);
            ++listed;
        }
    findings.push_back(
        {CheckKind::MoverUnseen,
         fmt::format(
             "entityId shows none of the {} rows of motion.movers, although {} of them should be "
             "in view, but rows such as {}: HostMover::row must be the value in the image",
             facts.movers.size(),
             inView,
             rows.empty() ? "none" : rows
         )}
    );
}

void checkUnlistedMovers(
    const CheckedFrame& now, const std::vector<CheckPoint>& points, std::vector<Finding>& findings
) {
    struct Row {
        uint32_t moves = 0;
        uint32_t stands = 0;
    };

    std::unordered_map<uint32_t, Row> rows;
    uint32_t stands = 0;
    for (const CheckPoint& point : points) {
        if (point.isSky || point.id == now.facts.noEntity)
            continue;
        const double off = glm::length(point.motion - point.camera);
        const bool moves = off > 1.0 + 0.05 * glm::length(point.camera);
        Row& row = rows[point.id];
        (moves ? row.moves : row.stands) += 1;
        stands += !moves;
    }
    for (const CheckFacts::Mover& mover : now.facts.movers)
        rows.erase(mover.row);
    // Where hardly anything agrees, it is the vectors that are wrong.
    if (stands < points.size() / 4)
        return;
    for (const auto& [row, counts] : rows)
        if (counts.moves >= 8 && counts.moves > 9 * counts.stands) {
            findings.push_back(
                {CheckKind::MoverUnlisted,
                 fmt::format(
                     "row {} moves by its vectors at {} of {} samples but is not in motion.movers, "
                     "so it is drawn as if it stood still: list it",
                     row,
                     counts.moves,
                     counts.moves + counts.stands
                 )}
            );
            return;
        }
}

void checkChangingIds(
    const CheckedFrame& now, const CheckedFrame& last, std::vector<Finding>& findings
) {
    if (now.facts.picture.width != last.facts.picture.width ||
        now.facts.picture.height != last.facts.picture.height)
        return;
    uint32_t still = 0;
    uint32_t changed = 0;
    uint32_t example = 0;
    for (uint32_t i = 0; i < shader::kCheckSamples; ++i) {
        const shader::CheckSample& a = last.totals.samples[i];
        const shader::CheckSample& b = now.totals.samples[i];
        // The same depth, to the bit, and no motion: the same surface.
        if (a.depth != b.depth || a.vector != b.vector || a.id == last.facts.noEntity)
            continue;
        const dvec2 motion = dvec2(b.vector) * dvec2(now.facts.convention.vectors.pixelsPerUnit);
        if (!(glm::length(motion) < 1.5))
            continue;
        ++still;
        if (a.id != b.id) {
            ++changed;
            example = i;
        }
    }
    if (still < 64 || changed * 4 < still)
        return;
    findings.push_back(
        {CheckKind::IdChanges,
         fmt::format(
             "entityId changed at {} of {} samples that stand still since the frame before, as "
             "from {} to {}: an entity keeps its id, or motion.rowIds says which row it has",
             changed,
             still,
             last.totals.samples[example].id,
             now.totals.samples[example].id
         )}
    );
}

} // namespace

void checkIds(const CheckedFrame& now, const CheckedFrame* last, std::vector<Finding>& findings) {
    const CheckFacts& facts = now.facts;
    if (!facts.hasIds)
        return;
    if (facts.rowCount > 0 && now.totals.counts[shader::kCheckIdBeyond] > 0)
        findings.push_back(
            {CheckKind::IdBeyond,
             fmt::format(
                 "entityId is not below motion.rowCount, {}, nor noEntity, {}, at {}; sky written "
                 "as another value is HostInputs::noEntity",
                 facts.rowCount,
                 facts.noEntity,
                 describeCount(now, shader::kCheckIdBeyond)
             )}
        );
    if (last && last->facts.hasIds && facts.hasVectors)
        checkChangingIds(now, *last, findings);
    if (!facts.readsMotion)
        return;
    if (!facts.movers.empty())
        checkListedMovers(now, findings);
    if (facts.hasVectors && hasCameras(facts) &&
        (facts.isNative || facts.convention.vectors.haveCamera))
        checkUnlistedMovers(now, makePoints(now, facts), findings);
}

} // namespace shutter::motion_blur
