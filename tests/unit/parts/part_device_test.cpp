// SPDX-License-Identifier: MIT
#include "game/parts/part_device.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

namespace shutter::parts {
namespace {

namespace fs = std::filesystem;

class DeviceFile : public testing::Test {
  protected:
    [[nodiscard]] size_t countFiles() const { return test::countFiles(mFolder.path()); }

    test::TempFolder mFolder;
    fs::path mFile = mFolder.path() / "device.json";
};

} // namespace

TEST_F(DeviceFile, TheFirstDeviceIsTheWorksAndOthersAreNamedAndRefused) {
    const auto none = readDevice(mFile);
    ASSERT_TRUE(none.ok());
    EXPECT_FALSE(none.value().has_value());
    EXPECT_TRUE(settleDevice(mFile, {"card", "driver 1"}, "film").ok());
    EXPECT_TRUE(settleDevice(mFile, {"card", "driver 1"}, "film").ok());
    for (const PartDevice& other : {PartDevice{"card", "driver 2"}, PartDevice{"c", "driver 1"}}) {
        const core::Status refused = settleDevice(mFile, other, "film");
        ASSERT_FALSE(refused.ok());
        for (const std::string& word :
             {std::string("the film is drawn by"),
              std::string("'card'"),
              std::string("'driver 1'"),
              "'" + other.name + "'",
              "'" + other.driver + "'"})
            EXPECT_NE(refused.error().message.find(word), std::string::npos)
                << refused.error().message;
    }
    const auto settled = readDevice(mFile);
    ASSERT_TRUE(settled.ok());
    EXPECT_EQ(*settled.value(), (PartDevice{"card", "driver 1"}));
    EXPECT_EQ(countFiles(), 1u);
}

TEST_F(DeviceFile, OfDevicesThatTryAtOnceOneIsTheWorks) {
    std::atomic<int> accepted = 0;
    {
        std::vector<std::jthread> threads;
        for (int i = 0; i < 8; ++i)
            threads.emplace_back([&, i] {
                if (settleDevice(mFile, {"card", std::to_string(i)}, "film").ok())
                    ++accepted;
            });
    }
    EXPECT_EQ(accepted, 1);
    EXPECT_EQ(countFiles(), 1u);
}

} // namespace shutter::parts
