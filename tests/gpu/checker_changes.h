// SPDX-License-Identifier: MIT
// Changes of what a host hands to the checker that several cases share.
#pragma once

#include "tests/gpu/checker_host.h"

namespace shutter::test {

/// To units in which vectors are so many times as long.
void scaleVectors(GivenFrame& given, const glm::vec2& factor);

/// Takes the camera's part out of the vectors.
void keepObjectsOnly(GivenFrame& given);

/// Stores depth with far at 1, at 1000 m where the camera is perspective.
void storeForwardDepth(GivenFrame& given);
/// Gives cameras of that depth.
void declareForwardDepth(GivenFrame& given);

/// Stores depth along the view.
void storeLinearDepth(GivenFrame& given, float unitsPerMetre);

/// Another jitter in each frame.
void declareJitter(GivenFrame& given, int frame);
/// Draws with it, and leaves it in the vectors.
void leaveJitter(GivenFrame& given, int frame);

/// Turns the cameras of each frame away from those of the frame before.
void turnAway(GivenFrame& given, int frame);

/// Share of the time between the frames at a shutter time: 0 the frame before, 1 this one.
[[nodiscard]] double shareAt(const GivenFrame& given, double shutterTime);

/// Keys of the frame before and of this one, as a host has them that knows no others.
void giveKeys(GivenFrame& given);
/// Keys at these shutter times.
void giveKeysAt(GivenFrame& given, const std::vector<double>& times);
/// A matrix for each key, of each listed mover that does not deform, and keys if there are none.
void giveMatrices(GivenFrame& given);

/// Keeps part of the picture only, which the lens does not lie in the middle of.
void cutOut(GivenFrame& given, const VkRect2D& part);

} // namespace shutter::test
