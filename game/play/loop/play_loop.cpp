// SPDX-License-Identifier: MIT
#include "game/play/loop/play_loop.h"

#include "engine/core/log.h"
#include "engine/core/words.h"
#include "engine/scene/auto_focus.h"
#include "engine/scene/lens.h"
#include "engine/scene/ray_cast.h"
#include "engine/scene/shutter.h"
#include "game/play/loop/picture_files.h"
#include "game/play/panel/effect_switches.h"
#include "game/play/panel/panel_sections.h"
#include "modules/debug_view/debug_view.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <set>
#include <thread>
#include <utility>

namespace shutter::game {

namespace {

/// After as many pictures all that the first view needs has been compiled.
constexpr uint32_t kPicturesOfTheStart = 30;
constexpr double kSingleStepSeconds = 1.0 / 60.0;
/// The keys are shown to a new player for as long, or until the panel is opened.
constexpr double kHintSeconds = 30.0;
/// A message is shown to a player for as long, or until the next.
constexpr double kMessageSeconds = 15.0;
/// Windows up to this height have text of the display's standard size.
constexpr double kPlainHeightPx = 1080.0;
/// The divider can be grabbed within this distance.
constexpr double kGrabPx = 8.0;

math::uvec2 scaledSize(const math::uvec2& window, double scale) {
    const auto side = [&](uint32_t px) {
        return std::max(static_cast<uint32_t>(std::lround(px * scale)), 1u);
    };
    return {side(window.x), side(window.y)};
}

std::vector<KeyHelp> listPhotoKeys() {
    return {
        {"W A S D Q E", "fly"},
        {"right drag", "turn the view"},
        {"wheel", "speed"},
        {"F", "focus on the middle"},
        {"F2", "save the picture"},
        {"T", "end"}};
}

/// What either the panel or the keyboard requests; the keyboard's speed wins.
PanelRequests join(const PanelRequests& panel, const PanelRequests& keys) {
    PanelRequests both;
    both.save = panel.save || keys.save;
    both.load = panel.load || keys.load;
    both.togglePause = panel.togglePause || keys.togglePause;
    both.savePicture = panel.savePicture || keys.savePicture;
    both.focusMiddle = panel.focusMiddle || keys.focusMiddle;
    both.focusOwn = panel.focusOwn || keys.focusOwn;
    both.singleStep = panel.singleStep || keys.singleStep;
    both.togglePhoto = panel.togglePhoto || keys.togglePhoto;
    both.toggleRecording = panel.toggleRecording || keys.toggleRecording;
    both.toggleFullScreen = panel.toggleFullScreen || keys.toggleFullScreen;
    both.quit = panel.quit || keys.quit;
    both.speed = keys.speed ? keys.speed : panel.speed;
    return both;
}

} // namespace

PlayLoop::PlayLoop(const PlayOptions& options, SessionWatch* watch)
    : mOptions(options), mWatch(watch), mStart(Clock::now()) {}

PlayLoop::~PlayLoop() {
    releaseDrawing();
}

void PlayLoop::releaseDrawing() {
    mRenderer.reset();
    mScreen.releaseDrawing();
}

core::Result<std::unique_ptr<PlayLoop>>
PlayLoop::open(const PlayOptions& options, SessionWatch* watch) {
    std::unique_ptr<PlayLoop> loop(new PlayLoop(options, watch));
    using Step = core::Status (PlayLoop::*)();
    for (const Step step : {&PlayLoop::openScript, &PlayLoop::openScreen, &PlayLoop::openStage})
        SHUTTER_TRY((loop.get()->*step)());
    return loop;
}

core::Status PlayLoop::openScript() {
    if (!mOptions.script.empty()) {
        auto script = app::readInputScript(mOptions.script, mOptions.shot.reach);
        if (!script)
            return script.error();
        mScript.emplace(std::move(script).value());
    }
    auto settings = mKeeper.open(mOptions, mScript.has_value(), mMessage);
    if (!settings)
        return settings.error();
    mSettings = std::move(settings).value();
    if (mKeeper.isFirstSession() && !mFiles.isFilming() && mScript == std::nullopt)
        mHintSeconds = kHintSeconds;
    return mFiles.open(
        mOptions, mScript ? core::FrameRate(1.0 / mScript->frameSeconds()) : mOptions.fps
    );
}

core::Status PlayLoop::openScreen() {
    SHUTTER_TRY(mScreen.open(mOptions, mSettings.vsync));
    if (mKeeper.isFirstSession() && mScreen.device().info().kind == "software")
        mMessage = SettingsKeeper::slowDown(mOptions, mSettings);
    for (const MethodInfo& method : listMethods())
        if (canRun(method, mScreen.device()))
            mMethods.emplace_back(method.name);
    replaceMissingMethods();
    return {};
}

core::Status PlayLoop::openStage() {
    SHUTTER_TRY(showNotice("loading"));
    if (mOptions.demo.empty()) {
        auto stage = loadSceneStage(mOptions.shot);
        if (!stage)
            return stage.error();
        mStage = std::move(stage).value();
    } else {
        auto demo = makeDemo(mOptions.demo, mOptions.assets);
        if (!demo)
            return demo.error();
        auto stage = makeDemoStage(std::move(demo).value(), mOptions.shot);
        if (!stage)
            return stage.error();
        mStage = std::move(stage).value();
    }
    if (mWatch)
        mStage = mWatch->wrap(std::move(mStage));
    mScreen.setTitle("Shutter: " + mStage->title());
    SHUTTER_TRY(showNotice("compiling shaders"));
    mRenderer = std::make_unique<PlayRenderer>(mScreen.device(), mStage->world().assets);
    warnOfPinhole();
    return {};
}

void PlayLoop::replaceMissingMethods() {
    for (std::string* method : {&mSettings.method, &mSettings.leftMethod}) {
        if (std::find(mMethods.begin(), mMethods.end(), *method) != mMethods.end())
            continue;
        mMessage = fmt::format(
            "method {} needs rays, which {} cannot trace: gather instead",
            *method,
            mScreen.device().info().name
        );
        core::logWarning("{}", mMessage);
        *method = "gather";
    }
}

core::Status PlayLoop::run() {
    startProgress();
    core::Status done;
    while (done && !mQuit)
        done = advance();
    mProgress.reset(); // before an error is printed
    return done ? finish() : done;
}

void PlayLoop::startProgress() {
    uint64_t frames = mOptions.frames;
    if (mScript)
        frames = std::min(frames > 0 ? frames : UINT64_MAX, mScript->countFrames());
    if (!mFiles.isFilming() || frames == 0)
        return;
    mProgress.emplace("filming", frames);
    mProgress->printLines();
}

core::Status PlayLoop::finish() {
    mRenderer->finishAll();
    SHUTTER_TRY(mFiles.takePictures(*mRenderer));
    SHUTTER_TRY(mFiles.finish());
    if (mRecorder.isRecording())
        toggleRecording();
    SHUTTER_TRY(writeRecord());
    releaseDrawing();
    if (const uint32_t messages = mScreen.device().validationMessageCount(); messages > 0)
        return core::Error{core::countOf(messages, "Vulkan validation message")};
    return {};
}

core::Status PlayLoop::writeRecord() {
    if (mOptions.stats.empty())
        return {};
    SessionFacts facts{
        mStage->title(), mScreen.device().info().name, mSettings.method, mScreen.size()};
    facts.score = mStage->score();
    facts.isOver = mStage->isOver();
    releaseDrawing(); // validation watches that, too
    facts.validationMessages = mScreen.device().validationMessageCount();
    return mRecord.write(mOptions.stats, facts);
}

double PlayLoop::measureFrame() {
    const Clock::time_point now = Clock::now();
    const double seconds =
        mLastTurn ? std::chrono::duration<double>(now - *mLastTurn).count() : 1.0 / 60.0;
    // A frame's time is that from one picture to the next.
    if (mLastTurn && mHasDrawn && mRecord.pictureCount() > 1)
        mRecord.addFrame(seconds);
    mHasDrawn = false;
    mLastTurn = now;
    if (mScript)
        return mScript->frameSeconds();
    // Films and runs without a window need no real time.
    return mFiles.isFilming() || !mScreen.hasWindow() ? mOptions.fps.secondsOf(1.0) : seconds;
}

core::Status PlayLoop::advance() {
    const math::uvec2 size = mScreen.size();
    const bool hidden = size.x == 0 || size.y == 0;
    // Between two sizes one turn goes without a picture; a window that takes none for longer is
    // polled again after a rest.
    const bool rests = hidden || mTurnsWithoutPicture > 1;
    mScreen.poll(rests && !mScript);
    if (rests && mScript)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    applyScript();
    mQuit = mQuit || mScreen.closeRequested();
    const double wallSeconds = measureFrame();
    app::InputState input = mScreen.collector(mScript.has_value()).take();
    if (hidden) // the game rests with it
        return {};
    apply(drawPanel(input, wallSeconds));
    input = filterInput(input);
    mTime = mClock.advance(wallSeconds);
    mPhotoCamera.advance(mStage->world(), input, wallSeconds, double(size.y));
    // Photo mode captures input; the game receives none.
    mStage->advance(
        mPhotoCamera.isOut() ? app::InputState() : input,
        {mTime, wallSeconds, double(size.y), mClock.isPaused()}
    );
    SHUTTER_TRY(drawPicture(mTime.duration));
    if (mOptions.frames > 0 && mRecord.pictureCount() >= mOptions.frames)
        mQuit = true;
    SHUTTER_TRY(mFiles.takePictures(*mRenderer));
    if (std::string news = mFiles.takeNews(); !news.empty()) {
        core::logInfo("{}", news);
        mMessage = std::move(news);
    }
    return {};
}

void PlayLoop::applyScript() {
    if (!mScript)
        return;
    const math::uvec2 size = glm::max(mScreen.size(), math::uvec2(1u));
    for (const app::ScriptEvent& event : mScript->takeFrame(mScreen.collector(true), size)) {
        if (const auto* resize = std::get_if<app::ResizeEvent>(&event.what)) {
            mScreen.resize(resize->size);
        } else if (const auto* action = std::get_if<app::WindowAction>(&event.what)) {
            mQuit = mQuit || *action == app::WindowAction::Quit;
            mScreen.apply(*action);
        } else if (const auto* shot = std::get_if<app::ScreenshotEvent>(&event.what)) {
            mFiles.addScreenshot(shot->file);
        }
    }
    if (mScript->isOver())
        mQuit = true;
}

app::InputState PlayLoop::filterInput(const app::InputState& input) {
    dragDivider(input);
    app::InputState left = input;
    if (mScreen.ui().wantsPointer() || mDraggingDivider) {
        left.buttons.reset();
        left.clicked.reset();
        left.wheel = 0.0;
    }
    if (mScreen.ui().wantsKeys()) {
        left.down.reset();
        left.pressed.reset();
    }
    return left;
}

void PlayLoop::dragDivider(const app::InputState& input) {
    const double width = std::max(mScreen.size().x, 1u);
    const double atPx = mSettings.dividerShare * width;
    const bool grabs = mSettings.split && !mScreen.ui().wantsPointer() &&
                       input.wasClicked(app::MouseButton::Left) &&
                       std::abs(input.pointerPx.x - atPx) <= kGrabPx;
    mDraggingDivider =
        input.isDown(app::MouseButton::Left) && (grabs || mDraggingDivider) && mSettings.split;
    if (mDraggingDivider)
        mSettings.dividerShare = std::clamp(input.pointerPx.x / width, 0.0, 1.0);
}

core::Status PlayLoop::showNotice(const std::string& text) {
    const math::uvec2 size = mScreen.size();
    if (!mScreen.hasWindow() || size.x == 0 || size.y == 0)
        return {};
    mScreen.poll(false); // some window managers show nothing before
    app::Ui& ui = mScreen.ui();
    ui.begin({}, size, chooseUiScale({}), 0.0);
    drawNotice(text);
    ui.end();
    return mScreen.showUi();
}

bool PlayLoop::isForPlayer() const {
    return mScreen.hasWindow() && !mScript && !mFiles.isFilming() && !mWatch;
}

PanelFacts PlayLoop::describeSession() const {
    PanelFacts facts;
    facts.title = mStage->title();
    facts.showsHint = mHintSeconds > 0.0;
    facts.message = mMessage;
    // Times differ between sessions; the pictures of a film or a watched session must not.
    if (!mFiles.isFilming() && !mWatch) {
        facts.right = mRenderer->statistics(PlaySide::Right);
        facts.left = mSettings.split ? mRenderer->statistics(PlaySide::Left) : nullptr;
        facts.frameMilliseconds = mRecord.meanMilliseconds();
    }
    facts.pictureSize = scaledSize(mScreen.size(), mSettings.resolutionScale);
    facts.exposure = mExposure;
    facts.paused = mClock.isPaused();
    facts.photo = mPhoto.isOn();
    facts.photoRays = mPhoto.rays();
    if (mPhoto.isOn())
        facts.photoMethod = chooseSettings().method;
    facts.lens = scene::lensAt(mStage->world(), camera(), mExposure.raster);
    if (isForPlayer() && !mPhoto.isOn())
        facts.notice = mFirstUse.notice();
    facts.speed = mClock.speed();
    facts.recording = mRecorder.isRecording();
    facts.methods = mMethods;
    facts.isViewMissing = mRenderer->isViewMissing();
    return facts;
}

PanelRequests PlayLoop::drawPanel(const app::InputState& input, double wallSeconds) {
    app::Ui& ui = mScreen.ui();
    ui.begin(input, mScreen.size(), chooseUiScale(input), wallSeconds);
    mHintSeconds = mSettings.showPanel
                       ? 0.0
                       : countHintDown(mHintSeconds, wallSeconds, mRecord.pictureCount() > 0);
    endMessage(wallSeconds);
    const std::vector<HudLine> hud = mStage->hud();
    const std::vector<KeyHelp> keys = mPhotoCamera.isOut() ? listPhotoKeys() : mStage->keys();
    PanelFacts facts = describeSession();
    facts.hud = hud;
    facts.keys = keys;
    const std::vector<std::string> views = listViews();
    facts.views = views;
    facts.showsHint = facts.showsHint || mPhotoCamera.isOut();
    const PanelRequests requests = mPanel.draw(facts, mSettings);
    ui.end();
    if (ui.wantsKeys())
        return requests;
    const PanelRequests all =
        join(requests, applyHotkeys(input, {mMethods, views}, mClock.speed(), mSettings));
    replaceMissingMethods(); // a preset's
    if (std::string why = explainIdleKeys(input, describeKeys(), mSettings); !why.empty())
        mMessage = std::move(why);
    return all;
}

void PlayLoop::endMessage(double wallSeconds) {
    if (std::exchange(mSeenMessage, mMessage) != mMessage)
        mMessageSeconds = kMessageSeconds;
    else if (isForPlayer())
        mMessageSeconds = countHintDown(mMessageSeconds, wallSeconds, mRecord.pictureCount() > 0);
    if (mMessageSeconds == 0.0)
        mMessage.clear();
}

KeyFacts PlayLoop::describeKeys() const {
    const scene::World& world = mStage->world();
    KeyFacts facts;
    if (mPhoto.isOn())
        facts.photoMethod = chooseSettings().method;
    facts.stageRests = mClock.isPaused() && mStage->readsKeysInSteps();
    facts.isCameraFixed = !mStage->readsKeysInSteps() && !mStage->holdsCamera();
    for (const EffectSwitch& effect : listEffectSwitches())
        facts.idleEffects.push_back(effect.explainIdle ? effect.explainIdle(world) : "");
    facts.speed = mClock.speed();
    return facts;
}

std::vector<std::string> PlayLoop::listViews() const {
    std::set<std::string> made = listFeatureIntermediates();
    const auto add = [&](const std::string& name) {
        if (const auto method = findMethod(name))
            made.merge(listIntermediates(*method.value()));
    };
    add(mSettings.method);
    if (mSettings.split)
        add(mSettings.leftMethod);
    std::vector<std::string> views;
    for (const debug_view::ViewInfo& view : debug_view::listViews()) {
        const std::set<std::string> sources = debug_view::listSources(view.name);
        if (std::includes(made.begin(), made.end(), sources.begin(), sources.end()))
            views.emplace_back(view.name);
    }
    return views;
}

void PlayLoop::apply(const PanelRequests& requests) {
    mQuit = mQuit || requests.quit;
    if (requests.togglePause || requests.togglePhoto || requests.singleStep)
        mMessage.clear(); // it may be of the pause, or of photo mode
    if (requests.togglePause) {
        mClock.setPaused(!mClock.isPaused());
        turnPhotoMode(false);
    }
    if (requests.togglePhoto)
        turnPhotoMode(!mPhoto.isOn());
    if (requests.speed)
        mClock.setSpeed(*requests.speed);
    if (requests.focusMiddle)
        focusOnMiddle();
    if (requests.focusOwn)
        focusAsCamera();
    if (requests.savePicture)
        savePicture();
    if (requests.singleStep) {
        turnPhotoMode(false);
        mClock.setPaused(true);
        mClock.stepOnce(kSingleStepSeconds);
    }
    if (requests.toggleFullScreen)
        mScreen.toggleFullScreen();
    if (requests.save)
        mMessage = mKeeper.save(mSettings);
    if (requests.load) {
        mMessage = mKeeper.load(mSettings);
        replaceMissingMethods();
    }
    if (requests.toggleRecording)
        toggleRecording();
}

void PlayLoop::turnPhotoMode(bool on) {
    const bool traces = std::find(mMethods.begin(), mMethods.end(), "truth") != mMethods.end();
    mPhoto.turn(on, traces);
    if (!on) {
        mPhotoCamera.putBack(mStage->world());
        return;
    }
    mClock.setPaused(true);
    overrideLens(); // which the photo's camera takes over
    if (!mStage->holdsCamera())
        mPhotoCamera.take(mStage->world(), mStage->camera(), mExposure.raster);
    if (!traces)
        mMessage = fmt::format(
            "{} traces no ray queries: the photo is drawn by {}",
            mScreen.device().info().name,
            chooseSettings().method
        );
}

void PlayLoop::overrideLens() {
    ecs::Registry& registry = mStage->world().registry;
    static const scene::LensOverride kNone;
    const scene::LensOverride lens = makeLens(mSettings);
    if (!core::areEqual(scene::listOverrideRows(), lens, kNone))
        registry.add(camera(), lens);
    else
        registry.remove<scene::LensOverride>(camera());
}

void PlayLoop::prepareLens() {
    overrideLens();
    scene::advanceAutoFocus(mStage->world(), mExposure.close);
}

void PlayLoop::focusOnMiddle() {
    scene::World& world = mStage->world();
    const auto distance = scene::findMiddleDistance(world, camera(), mExposure.raster);
    mSettings.lens.focusDistance = std::clamp(
        distance.value_or(scene::kFarthestFocus), scene::kNearestFocus, scene::kFarthestFocus
    );
    reportFocus(distance ? fmt::format("focused at {:.4g} m", *distance) : "focused at infinity");
}

void PlayLoop::focusAsCamera() {
    mSettings.lens.focusDistance = 0.0;
    reportFocus("focused as the camera itself does");
}

void PlayLoop::reportFocus(const std::string& focus) {
    const std::string why = explainPinhole();
    mMessage = why.empty() ? focus : focus + ", but " + why;
}

std::string PlayLoop::explainPinhole() const {
    const scene::World& world = mStage->world();
    if (world.registry.get<scene::Camera>(camera()).kind == scene::CameraKind::Orthographic)
        return "an orthographic camera has no lens";
    if (makeLens(mSettings).blurScale == 0.0)
        return "depth of field is off (panel, F1)";
    if (!scene::hasLens(world, camera()) && mSettings.lens.fStop == 0.0)
        return "the camera is a pinhole: choose an F-number (panel, F1)";
    const std::string wanted = chooseSettings().method;
    const std::string drawn =
        findDrawnMethod(wanted, mRenderer ? mRenderer->statistics(PlaySide::Right) : nullptr);
    const auto method = findMethod(drawn);
    if (!method || method.value()->hasLens)
        return {};
    if (drawn != wanted)
        return fmt::format("{} draws for {} and has no lens (panel, F1)", drawn, wanted);
    return fmt::format("{} draws pinholes: choose {}", drawn, listLensMethods("or"));
}

void PlayLoop::warnOfPinhole() {
    const bool opens = mOptions.fStop && *mOptions.fStop != 0.0;
    const bool focuses = mOptions.focusDistance || !mOptions.shot.focusEntity.empty();
    if (!opens && !focuses)
        return;
    const std::string why = explainPinhole();
    if (why.empty())
        return;
    const std::string warning = fmt::format(
        "{} changes nothing: {}", opens ? "--fstop" : nameFocusOption(mOptions.shot), why
    );
    core::logWarning("{}", warning);
    mMessage += (mMessage.empty() ? "" : "; ") + warning;
}

ecs::Entity PlayLoop::camera() const {
    return mPhotoCamera.isOut() ? mPhotoCamera.entity() : mStage->camera();
}

PlaySettings PlayLoop::chooseSettings() const {
    if (!mPhoto.isOn())
        return mSettings;
    return mPhoto.choose(mSettings, scene::hasLens(mStage->world(), camera()));
}

void PlayLoop::savePicture() {
    const PlaySettings settings = chooseSettings();
    const auto file = choosePhotoFile(mStage->title(), settings, mFiles.listPendingPhotos());
    std::optional<uint32_t> rays = mPhoto.rays();
    if (rays)
        *rays += mPhoto.raysToAdd(); // by the frame that is saved
    if (file)
        mFiles.addPhoto(
            file.value(), describePhoto(mStage->title(), settings, mTime.seconds, rays)
        );
    else
        mMessage = file.error().message;
}

double PlayLoop::chooseUiScale(const app::InputState& input) {
    const bool isHeld = input.isDown(app::MouseButton::Left) || mScreen.ui().wantsKeys();
    if (isHeld)
        return mUiScale;
    // In steps: while a window grows, fonts are not made in every frame.
    const double tall = std::floor(4.0 * mScreen.size().y / kPlainHeightPx) / 4.0;
    mUiScale = mSettings.uiScale * std::max(mScreen.contentScale(), tall);
    return mUiScale;
}

void PlayLoop::toggleRecording() {
    if (!mRecorder.isRecording()) {
        mRecorder.start();
        mMessage = "recording the camera's flight";
        return;
    }
    const auto file = mRecorder.finish(".");
    mMessage = file ? "recorded " + file.value().string() : file.error().message;
    core::logInfo("{}", mMessage);
}

void PlayLoop::chooseExposure(double duration) {
    scene::World& world = mStage->world();
    // A scene's own clock may start elsewhere than the game's.
    const double now = mTime.seconds + mStage->startSeconds();
    scene::CameraShutter shutter = makeShutter(mSettings);
    mStage->adjustShutter(now, shutter);
    world.registry.add(camera(), shutter);
    mExposure = scene::computeExposure(shutter, now, duration);
    // Simulated motion is known up to now: an exposure that ends later is drawn later.
    if (mExposure.close > now)
        mExposure =
            scene::computeExposure(shutter, now - (mExposure.close - mExposure.raster), duration);
    prepareLens();
}

core::Status PlayLoop::drawPicture(double duration) {
    math::uvec2 size = mScreen.size();
    if (size.x == 0 || size.y == 0)
        return {};
    PlaySettings settings = chooseSettings();
    if (isForPlayer() && !mPhoto.isOn()) // whose rays are one picture's
        settings = mFirstUse.choose(settings);
    mRenderer->makeRoom(settings);
    const gpu::Swapchain* swapchain = mScreen.swapchain();
    std::optional<gpu::SwapchainImage> shown;
    if (swapchain) {
        const bool fits = mScreen.fit(size, mSettings.vsync, *mRenderer);
        // A picture that is kept must be one that is shown: those wait for the window first.
        if (fits && mFiles.wantsPicture())
            shown = mScreen.acquire();
        if (!fits || (mFiles.wantsPicture() && !shown)) {
            ++mTurnsWithoutPicture;
            return {};
        }
        size = {swapchain->desc().width, swapchain->desc().height};
    }
    chooseExposure(duration);
    PlayPicture picture = makePicture(size, settings);
    mRecorder.addFrame(mStage->world(), picture.view);
    if (swapchain)
        picture.window.acquire = [&] {
            if (!shown)
                shown = mScreen.acquire();
            return shown;
        };
    if (picture.readBack && swapchain && !swapchain->canBeRead()) {
        if (mFiles.isFilming())
            return core::makeError("this display's pictures cannot be read: no film");
        mFiles.dropRequests();
        mMessage = "this display's pictures cannot be read: no screenshots";
        picture.readBack = false;
    }
    if (mPhoto.isTracing())
        picture.moreRays = {
            mPhoto.begin(mStage->world(), picture.view, settings.picture.features),
            mPhoto.raysToAdd()};
    SHUTTER_TRY(mRenderer->draw(mStage->world(), picture, settings));
    if (mPhoto.isTracing())
        mPhoto.end();
    mTurnsWithoutPicture = shown || !swapchain ? 0 : mTurnsWithoutPicture + 1;
    if (swapchain && !shown)
        return {};
    if (shown)
        mScreen.present(*shown);
    notePicture();
    return {};
}

PlayPicture PlayLoop::makePicture(const math::uvec2& sizePx, const PlaySettings& settings) {
    const math::uvec2 drawn = scaledSize(sizePx, settings.resolutionScale);
    const DemoAppearance appearance = mStage->appearance();
    PlayPicture picture;
    picture.view.camera = camera();
    picture.view.exposure = mExposure;
    picture.view.width = drawn.x;
    picture.view.height = drawn.y;
    picture.view.frameFit = settings.picture.frameFit;
    picture.view.background = appearance.background;
    picture.view.ambient = appearance.ambient;
    picture.view.environment = settings.environment;
    picture.view.unseenMatters = unseenMatters(settings.picture.features);
    picture.window.size = sizePx;
    const bool isBare = mFiles.wantsPhoto() || (mFiles.isFilming() && !mOptions.filmsHud);
    picture.window.overlay = isBare ? nullptr : &mScreen.ui();
    picture.wantReasons = settings.showPanel;
    picture.untilReady =
        isForPlayer() ? motion_blur::UntilReady::StandIn : motion_blur::UntilReady::Wait;
    picture.readBack = mFiles.wantsPicture();
    return picture;
}

void PlayLoop::notePicture() {
    mFiles.notePicture();
    mHasDrawn = true;
    if (mProgress)
        mProgress->advance();
    if (mRecord.pictureCount() == kPicturesOfTheStart)
        mScreen.keepPipelines();
    mRecord.addPicture(std::chrono::duration<double>(Clock::now() - mStart).count());
    mRecord.addAllocations(mTime.seconds, mScreen.device().allocationCount());
    if (const auto* statistics = mRenderer->statistics(PlaySide::Right))
        mRecord.addStatistics(*statistics);
    if (mWatch)
        mWatch->notePicture(mRecord.pictureCount() - 1, mScreen.device(), [this] {
            mRenderer->finishAll();
        });
}

} // namespace shutter::game
