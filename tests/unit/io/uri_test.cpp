// SPDX-License-Identifier: MIT
#include "engine/io/uri.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>

namespace shutter::io {

namespace {

using test::TempFolder;

namespace fs = std::filesystem;

std::string decodeText(std::string_view uri) {
    const auto bytes = decodeDataUri(uri);
    return bytes ? std::string(bytes.value().begin(), bytes.value().end()) : "refused";
}

TEST(DataUri, Base64OfEveryPaddingDecodes) {
    EXPECT_EQ(decodeText("data:application/octet-stream;base64,"), "");
    EXPECT_EQ(decodeText("data:;base64,Zg=="), "f");
    EXPECT_EQ(decodeText("data:;base64,Zm8="), "fo");
    EXPECT_EQ(decodeText("data:;base64,Zm9v"), "foo");
    EXPECT_EQ(decodeText("data:;base64,Zm9vYg"), "foob") << "without padding";
}

TEST(DataUri, PercentEncodedTextDecodes) {
    EXPECT_EQ(decodeText("data:,a%20b%2C"), "a b,");
}

TEST(DataUri, MediaTypesAndParametersAreRead) {
    EXPECT_EQ(decodeText("data:image/svg+xml;charset=utf-8;BASE64,Zg=="), "f");
    EXPECT_EQ(decodeText("data:;charset=utf-8,a"), "a");
    EXPECT_EQ(decodeText("data:;name=a%20b;base64,Zg%3D%3D"), "f");
}

TEST(DataUri, WhatIsNoMediaTypeOrParameterIsRefused) {
    for (const char* header :
         {";",
          ";;base64",
          ";base64;",
          ";base64;charset=utf-8",
          ";base64;base64",
          ";base65",
          ";charset",
          ";=utf-8",
          ";charset=",
          ";charset=a=b",
          ";charset=utf 8;base64",
          "base64",
          "text;base64",
          "text/;base64",
          "/plain;base64",
          "text/plain/more;base64",
          " ;base64"}) {
        EXPECT_EQ(decodeText(std::string("data:") + header + ",Zg=="), "refused") << header;
    }
}

TEST(DataUri, PaddingThatFillsNoGroupIsRefused) {
    for (const char* data : {"Zg=", "Zg===", "Zm8==", "Zm9v=", "Zm9v====", "Z===", "=", "Z=g="})
        EXPECT_EQ(decodeText(std::string("data:;base64,") + data), "refused") << data;
    EXPECT_EQ(decodeText("data:;base64,Zh=="), "refused") << "bits after the last byte";
}

TEST(DataUri, MalformedOnesAreRefused) {
    EXPECT_EQ(decodeText("data:;base64"), "refused") << "no comma";
    EXPECT_EQ(decodeText("data:;base64,Zm9*"), "refused") << "no base64 digit";
    EXPECT_EQ(decodeText("data:;base64,Zm9vY"), "refused") << "one digit too many";
    EXPECT_EQ(decodeText("data:,%4"), "refused");
    EXPECT_EQ(decodeText("http://x,y"), "refused");
}

TEST(ResolveUri, PlainNamesSpacesAndUnicodeStayInTheFolder) {
    const TempFolder folder;
    EXPECT_EQ(resolveUri(folder.path(), "a.bin").value(), folder.path() / "a.bin");
    EXPECT_EQ(resolveUri(folder.path(), "sub/a%20b.png").value(), folder.path() / "sub/a b.png");
    EXPECT_EQ(resolveUri(folder.path(), "a b.png").value(), folder.path() / "a b.png");
    EXPECT_EQ(resolveUri(folder.path(), "%E2%9D%A4.png").value(), folder.path() / "\u2764.png");
    EXPECT_EQ(resolveUri(folder.path(), "..a/b..").value(), folder.path() / "..a/b..");
}

TEST(ResolveUri, StepsThatStayInTheFolderAreResolvedInTheText) {
    const TempFolder folder;
    const TempFolder outside;
    folder.write("sub/deep/a.bin", "x");
    fs::create_symlink(outside.path(), folder.path() / "out");
    for (const char* uri :
         {"a.bin",
          "./a.bin",
          ".//./a.bin",
          "sub/../a.bin",
          "sub/./../a.bin",
          "sub/deep/../../a.bin",
          "sub/../sub/deep/../../a.bin",
          "sub/%2e%2e/a.bin",
          "sub%2F..%2Fa.bin",
          "no/such/../../a.bin",
          "out/../a.bin"})
        for (const Reach reach : {Reach::Folder, Reach::Anywhere}) {
            const auto file = resolveUri(folder.path(), uri, reach);
            ASSERT_TRUE(file) << uri;
            EXPECT_EQ(file.value(), folder.path() / "a.bin") << uri;
        }
    EXPECT_EQ(resolveUri("", "sub/../a.bin").value(), "./a.bin");
}

class RefusedUri : public testing::TestWithParam<const char*> {};

TEST_P(RefusedUri, IsAnError) {
    const TempFolder folder;
    EXPECT_FALSE(resolveUri(folder.path(), GetParam()));
}

INSTANTIATE_TEST_SUITE_P(
    Uris,
    RefusedUri,
    testing::Values(
        "",
        "../a.bin",
        "..",
        "./../a.bin",
        "sub/../../a.bin",
        "sub/deep/../../../a.bin",
        "sub/%2e%2e/%2E%2E/a.bin",
        "sub\\..\\a.bin",
        "sub/..\\a.bin",
        "%2e%2e/a.bin",
        "..%2fa.bin",
        "..\\a.bin",
        "/etc/hostname",
        "%2Fetc/hostname",
        "file:///etc/hostname",
        "FILE:a.bin",
        "http://127.0.0.1/a.bin",
        "C:/a.bin",
        "a%zz.bin",
        "a%2",
        "a%00.bin"
    )
);

TEST(ResolveUri, AnEndlessUriIsRefusedAndShortenedInTheMessage) {
    const TempFolder folder;
    const auto file = resolveUri(folder.path(), std::string(100000, 'a'));
    ASSERT_FALSE(file);
    EXPECT_LT(file.error().message.size(), 200u);
}

TEST(ResolveUri, ALinkOutOfTheFolderIsRefusedAndOneInsideIsFollowed) {
    const TempFolder outside;
    outside.write("secret.bin", "x");
    const TempFolder folder;
    folder.write("real.bin", "x");
    fs::create_symlink(outside.path() / "secret.bin", folder.path() / "out.bin");
    fs::create_symlink("real.bin", folder.path() / "in.bin");
    EXPECT_FALSE(resolveUri(folder.path(), "out.bin"));
    EXPECT_FALSE(resolveUri(folder.path(), "sub/../out.bin"));
    EXPECT_TRUE(resolveUri(folder.path(), "in.bin"));
}

TEST(ResolveUri, PathsThatLeaveTheFolderAreTakenFromThoseWhoMayAndSchemesFromNobody) {
    const TempFolder folder;
    const auto resolve = [&](std::string_view uri) {
        return resolveUri(folder.path(), uri, Reach::Anywhere);
    };
    EXPECT_EQ(resolve("../a.bin").value(), folder.path() / "../a.bin");
    EXPECT_EQ(resolve("/etc/hostname").value(), "/etc/hostname");
    for (const char* uri : {"file:///etc/hostname", "http://127.0.0.1/a.bin", "a%00.bin", ""})
        EXPECT_FALSE(resolve(uri)) << uri;
}

TEST(LiesInside, FollowsLinksAndSteps) {
    const TempFolder outside;
    const TempFolder folder;
    folder.write("sub/a.bin", "x");
    fs::create_symlink(outside.path(), folder.path() / "out");
    for (const char* inside : {"a", "sub/a.bin", "sub/../b", "no/such/folder"})
        EXPECT_TRUE(liesInside(folder.path(), inside)) << inside;
    EXPECT_TRUE(liesInside(folder.path(), folder.path() / "a"));
    for (const char* away : {"..", "sub/../../a", "out/a", "/etc/hostname"})
        EXPECT_FALSE(liesInside(folder.path(), away)) << away;
    EXPECT_TRUE(liesInside("", "a"));
    EXPECT_FALSE(liesInside("", "../a"));
}

} // namespace

} // namespace shutter::io
