// SPDX-License-Identifier: MIT
#include "game/output/extra_files.h"
#include "game/shot/picture_drawer.h"

#include <gtest/gtest.h>

namespace shutter::game {

TEST(Intermediates, AllIntermediatesOfAMethodCanBeWrittenAndViewed) {
    for (const MethodInfo& method : listMethods())
        for (const std::string& name : listIntermediates(method)) {
            const debug_view::ViewInfo* view = debug_view::findView(name);
            ASSERT_TRUE(view) << method.name << " has " << name;
            EXPECT_FALSE(view->channels.empty()) << name;
            EXPECT_EQ(debug_view::listSources(name), std::set{name});
        }
}

} // namespace shutter::game
