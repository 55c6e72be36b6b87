// SPDX-License-Identifier: MIT
// Checks a host's ids against its movers, and their persistence between frames.
#include "modules/motion_blur/embedding/check/last_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
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
    uint32_t inFrustum = 0;
    bool anySeen = false;
    const FineDepth depth(now, facts);
    for (const CheckFacts::Mover& mover : facts.movers) {
        if (mover.row >= seen.size())
            return; // more than are tracked
        anySeen = anySeen || seen[mover.row];
        inFrustum += mover.isInView;
        // Hidden behind a wall, it is not counted.
        inView += mover.isInView && !seen[mover.row] && depth.isNear(mover.place, mover.metres);
    }
    // Games list what they do not draw, the player's own body and what was culled: some such
    // origins lie by chance on a surface that is seen.
    if (anySeen || inView == 0 || 2 * inView < inFrustum)
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
             "entityId shows none of the {} rows of movers, although {} of them should be "
             "in view, but rows such as {}: ShutterBlurMover::row must be the value in the image",
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
                     "row {} moves by its vectors at {} of {} samples but is not in movers, "
                     "so it is drawn as if it stood still: list it",
                     row,
                     counts.moves,
                     counts.moves + counts.stands
                 )}
            );
            return;
        }
}

/// An id that lasts, of a row.
uint64_t lastingId(const CheckFacts& facts, uint32_t row) {
    return row < facts.rowIds.size() ? facts.rowIds[row] : row;
}

/// Place of a sample's surface in the previous frame, pixels and metres; nothing: unknown.
std::optional<std::pair<dvec2, double>>
findBefore(const CheckFacts& facts, const CheckPoint& point) {
    const bool hasCameras = facts.convention.cameras.areGiven;
    const double metres = hasCameras ? point.metresBefore : point.metres;
    if (!facts.hasVectors)
        return std::pair(point.place - point.camera, metres);
    // Over an exposure of unknown length.
    if (facts.isNative && hasCameras)
        return std::pair(point.place - point.camera, metres);
    if (facts.isNative && !(glm::length(point.motion) < 1.5))
        return std::nullopt;
    const dvec2 motion =
        facts.convention.vectors.lackCamera ? point.motion + point.camera : point.motion;
    return std::pair(point.place - (facts.isNative ? dvec2(0.0) : motion), metres);
}

/// Compares ids of surfaces visible in both frames, well within its entity in both.
void checkChangingIds(
    const CheckedFrame& now, const CheckedFrame& last, std::vector<Finding>& findings
) {
    CheckFacts facts = now.facts;
    facts.hasExposureCameras = false; // those of the frame count
    if (facts.picture.width != last.facts.picture.width ||
        facts.picture.height != last.facts.picture.height)
        return;
    const FineGrid grid(now);
    const FineDepth then(last, last.facts);
    uint32_t found = 0;
    uint32_t changed = 0;
    std::pair<uint32_t, uint32_t> example;
    for (const CheckPoint& point : makePoints(now, facts)) {
        if (point.isSky || point.id == facts.noEntity)
            continue;
        const auto before = findBefore(facts, point);
        if (!before || then.compare(before->first, before->second) != Match::Same)
            continue;
        const auto idNow = grid.findId(point.place);
        const auto idThen = then.grid().findId(before->first);
        if (!idNow || !idThen || *idThen == last.facts.noEntity)
            continue;
        ++found;
        if (lastingId(facts, *idNow) == lastingId(last.facts, *idThen))
            continue;
        ++changed;
        example = {*idThen, *idNow};
    }
    if (found < 64 || changed * 4 < found)
        return;
    findings.push_back(
        {CheckKind::IdChanges,
         fmt::format(
             "entityId changed at {} of {} samples whose surface the frame before shows as well, "
             "as "
             "from {} to {}: an entity keeps its id, or rowIds names the row that it has",
             changed,
             found,
             example.first,
             example.second
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
                 "entityId is not below rowCount, {}, nor noEntity, {}, at {}; sky written "
                 "as another value is noEntity",
                 facts.rowCount,
                 facts.noEntity,
                 describeCount(now, shader::kCheckIdBeyond)
             )}
        );
    // Surfaces are not where a wrong camera puts them.
    const bool isCameraWrong = facts.convention.scales.isCut || hasFound(
                                                                    findings,
                                                                    {CheckKind::Vectors,
                                                                     CheckKind::DepthDirection,
                                                                     CheckKind::CameraJump,
                                                                     CheckKind::Keys,
                                                                     CheckKind::Unexplained}
                                                                );
    if (last && last->facts.hasIds && !isCameraWrong)
        checkChangingIds(now, *last, findings);
    if (!facts.readsMotion)
        return;
    if (!facts.movers.empty())
        checkListedMovers(now, findings);
    if (facts.hasVectors && hasCameras(facts) && !isCameraWrong &&
        (facts.isNative || !facts.convention.vectors.lackCamera))
        checkUnlistedMovers(now, makePoints(now, facts), findings);
}

} // namespace shutter::motion_blur
