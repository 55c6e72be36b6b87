// SPDX-License-Identifier: MIT
#include "game/bench/frame_judge.h"

#include "engine/core/parallel_jobs.h"
#include "engine/image/flip.h"
#include "engine/image/metrics.h"
#include "engine/io/image_file.h"
#include "game/bench/sequence/temporal_error.h"

#include <utility>

namespace shutter::bench {

core::Status FrameJudge::judge(std::vector<FramePicture>& pictures) {
    SHUTTER_CHECK(!pictures.empty(), "a frame has a truth");
    const FramePicture& truth = pictures.front();
    std::vector<Before> kept(pictures.size());
    std::vector<core::Status> written(pictures.size());
    core::runParallelJobs(pictures.size(), [&](size_t i) {
        FramePicture& picture = pictures[i];
        if (i > 0)
            judgePicture(truth, picture, kept[i]);
        if (!picture.file.empty())
            written[i] = io::writeImage(picture.file, picture.shown);
    });
    for (const core::Status& status : written)
        if (!status)
            return status;
    mBefore.clear();
    for (size_t i = 0; i < pictures.size(); ++i) {
        if (pictures[i].judgement == Judgement::Squares)
            continue;
        kept[i].shown = std::move(pictures[i].shown);
        mBefore[pictures[i].key] = std::move(kept[i]);
    }
    return {};
}

void FrameJudge::judgePicture(const FramePicture& truth, FramePicture& picture, Before& kept)
    const {
    std::map<std::string, double>& metrics = picture.record.picture.metrics;
    const bool isWhole = picture.judgement == Judgement::Whole;
    if (picture.judgement != Judgement::InTime)
        metrics["psnr"] = image::computePsnr(picture.shown, truth.shown);
    if (isWhole) {
        metrics["ssim"] = image::computeSsim(picture.shown, truth.shown);
        metrics["flip"] = image::computeFlip(picture.shown, truth.shown).mean;
        kept.fine = computeFineError(picture.shown, truth.shown);
        if (picture.linear.width > 0 && truth.linear.width > 0)
            metrics["hdrFlip"] = image::computeHdrFlip(picture.linear, truth.linear).mean;
    }
    const auto before = mBefore.find(picture.key);
    const auto truthBefore = mBefore.find(truth.key);
    if (picture.judgement == Judgement::Squares || before == mBefore.end() ||
        truthBefore == mBefore.end())
        return;
    metrics["flicker"] = computeFlicker(
        {before->second.shown, truthBefore->second.shown}, {picture.shown, truth.shown}
    );
    if (isWhole)
        metrics["fixedPower"] = computeFixedPower(before->second.fine, kept.fine);
}

void FrameJudge::goOnFrom(const std::string& truthKey, std::map<std::string, image::Image> shown) {
    mBefore.clear();
    const image::Image truth = shown.at(truthKey);
    for (auto& [key, picture] : shown) {
        image::Image fine = computeFineError(picture, truth);
        mBefore[key] = {std::move(picture), std::move(fine)};
    }
}

} // namespace shutter::bench
