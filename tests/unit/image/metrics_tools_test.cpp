// SPDX-License-Identifier: MIT
// Our metrics against tools that we did not write. Each test skips where its tool is not installed.
#include "engine/image/metrics.h"
#include "tests/unit/image/test_images.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <system_error>
#include <unistd.h>

using namespace shutter::image;

namespace {

/// Each third value scaled, the rest as it was.
Image disturb(const Image& image) {
    Image result = image;
    for (size_t i = 0; i < result.pixels.size(); i += 3)
        result.pixels[i] = std::round(result.pixels[i] * 200.0f) / 255.0f;
    return result;
}

/// An empty folder that goes with the object.
class TemporaryFolder {
  public:
    TemporaryFolder() {
        std::string pattern =
            (std::filesystem::temp_directory_path() / "shutter-metrics-XXXXXX").string();
        const char* made = mkdtemp(pattern.data());
        mPath = made == nullptr ? "" : made;
    }

    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(mPath, ignored);
    }

    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return mPath; }

  private:
    std::filesystem::path mPath;
};

/// Binary PGM (one channel) or PPM (three), eight bits.
void writePnm(const Image& image, const std::filesystem::path& path) {
    std::ofstream file(path, std::ios::binary);
    file << (image.channels == 1 ? "P5" : "P6") << "\n"
         << image.width << " " << image.height << "\n255\n";
    for (float value : image.pixels)
        file.put(static_cast<char>(std::lround(value * 255.0f)));
    ASSERT_TRUE(file.good()) << path;
}

/// Everything that the command prints; a failure of the test, and nothing, unless it exits with 0.
std::optional<std::string> readOutput(const std::string& command) {
    FILE* pipe = popen((command + " 2>&1").c_str(), "r");
    if (pipe == nullptr) {
        ADD_FAILURE() << "cannot run: " << command;
        return std::nullopt;
    }
    std::string output;
    std::array<char, 512> chunk{};
    while (fgets(chunk.data(), int(chunk.size()), pipe) != nullptr)
        output += chunk.data();
    if (pclose(pipe) == 0)
        return output;
    ADD_FAILURE() << command << "\nsaid:\n" << output;
    return std::nullopt;
}

/// For a shell; the temporary folder's name has no quote in it.
std::string quote(const std::filesystem::path& path) {
    std::string quoted = "'";
    quoted += path.string();
    quoted += '\'';
    return quoted;
}

/// Both pictures as files of eight bits in a folder of their own.
class WrittenPair {
  public:
    WrittenPair(const Image& a, const Image& b)
        : mA(mFolder.path() / (a.channels == 1 ? "a.pgm" : "a.ppm")),
          mB(mFolder.path() / (b.channels == 1 ? "b.pgm" : "b.ppm")) {
        writePnm(a, mA);
        writePnm(b, mB);
    }

    [[nodiscard]] std::string a() const { return quote(mA); }

    [[nodiscard]] std::string b() const { return quote(mB); }

  private:
    TemporaryFolder mFolder;
    std::filesystem::path mA;
    std::filesystem::path mB;
};

bool isFfmpegInstalled() {
    return std::system("command -v ffmpeg >/dev/null 2>&1") == 0;
}

/// PSNR by ffmpeg's filter; the plane format keeps RGB as it is.
std::optional<double> measureWithFfmpeg(const Image& a, const Image& b) {
    const WrittenPair files(a, b);
    const std::string format = a.channels == 1 ? "gray" : "gbrp";
    const std::optional<std::string> output = readOutput(
        "ffmpeg -nostdin -hide_banner -i " + files.a() + " -i " + files.b() +
        " -lavfi '[0:v]format=" + format + "[a];[1:v]format=" + format + "[b];[a][b]psnr' -f null -"
    );
    const size_t average = output ? output->find("average:") : std::string::npos;
    if (average == std::string::npos)
        return std::nullopt;
    return std::strtod(output->c_str() + average + 8, nullptr);
}

/// A Python that has scikit-image; distributions install it for their own, which need not be the
/// first in PATH.
std::optional<std::string> findPythonWithSkimage() {
    for (const char* python : {"python3", "/usr/bin/python3"})
        if (std::system(
                (std::string(python) + " -c 'import skimage.metrics' >/dev/null 2>&1").c_str()
            ) == 0)
            return python;
    return std::nullopt;
}

/// Wang 2004 by scikit-image over Rec. 709 luminance, mean over whole windows. (ffmpeg's ssim
/// filter is no help: its windows are 8x8 and flat.)
constexpr const char* kSkimageScript = R"(
import sys
import numpy
from skimage.metrics import structural_similarity

def load(path):
    kind, size, peak, body = open(path, "rb").read().split(b"\n", 3)
    width, height = map(int, size.split())
    values = numpy.frombuffer(body, numpy.uint8).reshape(height, width, -1) / 255.0
    return values[..., 0] if kind == b"P5" else values @ [0.2126, 0.7152, 0.0722]

_, scores = structural_similarity(
    load(sys.argv[1]), load(sys.argv[2]), gaussian_weights=True, sigma=1.5,
    use_sample_covariance=False, data_range=1.0, full=True)
print("%.12f" % scores[5:-5, 5:-5].mean())
)";

std::optional<double>
measureWithSkimage(const std::string& python, const Image& a, const Image& b) {
    const WrittenPair files(a, b);
    const auto output = readOutput(
        python + " - " + files.a() + " " + files.b() + " <<'PYTHON'" + kSkimageScript + "PYTHON\n"
    );
    if (!output)
        return std::nullopt;
    return std::strtod(output->c_str(), nullptr);
}

} // namespace

TEST(Psnr, AgreesWithFfmpegOnGreyPictures) {
    if (!isFfmpegInstalled())
        GTEST_SKIP() << "ffmpeg is not installed";
    const Image a = makeNoise(64, 48, 1, 2);
    const Image b = disturb(a);
    const std::optional<double> expectedDb = measureWithFfmpeg(a, b);
    ASSERT_TRUE(expectedDb.has_value());
    EXPECT_NEAR(computePsnr(a, b), *expectedDb, 0.01);
}

TEST(Psnr, AgreesWithFfmpegOnColourPictures) {
    if (!isFfmpegInstalled())
        GTEST_SKIP() << "ffmpeg is not installed";
    const Image a = makeNoise(64, 48, 3, 3);
    const Image b = makeNoise(64, 48, 3, 4);
    const std::optional<double> expectedDb = measureWithFfmpeg(a, b);
    ASSERT_TRUE(expectedDb.has_value());
    EXPECT_NEAR(computePsnr(a, b), *expectedDb, 0.01);
}

TEST(Ssim, AgreesWithScikitImage) {
    const std::optional<std::string> python = findPythonWithSkimage();
    if (!python)
        GTEST_SKIP() << "scikit-image is not installed (package python3-skimage)";
    for (const uint32_t channels : {1u, 3u}) {
        const Image a = makeNoise(64, 48, channels, 5);
        for (const Image& b : {disturb(a), makeNoise(64, 48, channels, 6)}) {
            const std::optional<double> expected = measureWithSkimage(*python, a, b);
            ASSERT_TRUE(expected.has_value());
            EXPECT_NEAR(computeSsim(a, b), *expected, 1e-6) << channels << " channels";
        }
    }
}
