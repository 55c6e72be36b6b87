// SPDX-License-Identifier: MIT
#include "game/play/loop/play_loop.h"

#include "engine/core/log.h"
#include "engine/io/image_file.h"
#include "engine/scene/shutter.h"
#include "game/options/folders.h"
#include "modules/debug_view/debug_view.h"

#include <algorithm>
#include <cmath>
#include <system_error>
#include <thread>
#include <utility>

namespace shutter::game {

namespace {

constexpr double kSingleStepSeconds = 1.0 / 60.0;
/// Of a player without settings: a third of a frame at 20 frames a second.
constexpr double kFirstBudgetMilliseconds = 16.0;
/// The divider can be grabbed this far beside it.
constexpr double kGrabPx = 8.0;

math::uvec2 scaledSize(const math::uvec2& window, double scale) {
    const auto side = [&](uint32_t px) {
        return std::max(static_cast<uint32_t>(std::lround(px * scale)), 1u);
    };
    return {side(window.x), side(window.y)};
}

} // namespace

PlayLoop::PlayLoop(const PlayOptions& options) : mOptions(options), mStart(Clock::now()) {}

PlayLoop::~PlayLoop() {
    releaseDrawing();
}

void PlayLoop::releaseDrawing() {
    mRenderer.reset();
    mUi.reset();
    mSwapchain.reset(); // before the window that it shows on
}

core::Result<std::unique_ptr<PlayLoop>> PlayLoop::open(const PlayOptions& options) {
    std::unique_ptr<PlayLoop> loop(new PlayLoop(options));
    using Step = core::Status (PlayLoop::*)();
    for (const Step step :
         {&PlayLoop::openSettings,
          &PlayLoop::openFilm,
          &PlayLoop::openDevice,
          &PlayLoop::openStage})
        if (core::Status done = (loop.get()->*step)(); !done)
            return done.error();
    return loop;
}

core::Status PlayLoop::openSettings() {
    if (!mOptions.script.empty()) {
        auto script = app::readInputScript(mOptions.script);
        if (!script)
            return script.error();
        mScript.emplace(std::move(script).value());
    }
    // What a script shows depends on nothing that a person left behind.
    const bool isOwn = mOptions.settings.empty() && !mScript;
    mSettingsFile = isOwn ? findSettingsFile() : mOptions.settings;
    std::error_code ignored;
    if (!mSettingsFile.empty() && (!isOwn || std::filesystem::exists(mSettingsFile, ignored))) {
        auto loaded = loadPlaySettings(mSettingsFile);
        if (!loaded && !isOwn)
            return loaded.error();
        if (!loaded)
            refuseSettings(loaded.error().message);
        else
            mSettings = std::move(loaded).value();
    }
    // A person's first session keeps its rate; scripts and films depend on no clock.
    if (isOwn && mOptions.film.empty() && !std::filesystem::exists(mSettingsFile, ignored))
        mSettings.budget.milliseconds = kFirstBudgetMilliseconds;
    if (mOptions.method)
        mSettings.method = *mOptions.method;
    if (mOptions.vsync)
        mSettings.vsync = *mOptions.vsync;
    if (!mOptions.film.empty() && mOptions.settings.empty())
        mSettings.showPanel = false;
    return {};
}

core::Status PlayLoop::openDevice() {
    const ShotOptions& shot = mOptions.shot;
    gpu::DeviceOptions wanted = mOptions.device;
    wanted.cacheFolder = findCacheFolder();
    mHeadlessSize = {shot.width, shot.height};
    if (mOptions.hasWindow) {
        auto window = app::Window::open({"Shutter", shot.width, shot.height});
        if (!window)
            return core::makeError("{}; --no-window does without", window.error().message);
        mWindow = std::move(window).value();
        wanted.surfaceExtensions = mWindow->surfaceExtensions();
    }
    auto device = gpu::Device::create(wanted);
    if (!device)
        return device.error();
    mDevice = std::move(device).value();
    if (mWindow) {
        auto surface = mWindow->createSurface(mDevice->instance());
        if (!surface)
            return surface.error();
        const math::uvec2 size = mWindow->framebufferSize();
        auto swapchain =
            gpu::Swapchain::create(*mDevice, surface.value(), {size.x, size.y, mSettings.vsync});
        if (!swapchain)
            return swapchain.error();
        mSwapchain = std::move(swapchain).value();
    }
    mUi = std::make_unique<app::Ui>(*mDevice);
    for (const MethodInfo& method : listMethods())
        if (canRun(method, *mDevice))
            mMethods.emplace_back(method.name);
    for (const debug_view::ViewInfo& view : debug_view::listViews())
        mViews.emplace_back(view.name);
    replaceMissingMethods();
    return {};
}

core::Status PlayLoop::openStage() {
    if (mOptions.demo.empty()) {
        auto stage = loadSceneStage(mOptions.shot);
        if (!stage)
            return stage.error();
        mStage = std::move(stage).value();
    } else {
        auto demo = makeDemo(mOptions.demo, mOptions.assets);
        if (!demo)
            return demo.error();
        mStage = makeDemoStage(std::move(demo).value());
    }
    mRenderer = std::make_unique<PlayRenderer>(*mDevice, mStage->world().assets);
    if (mWindow)
        mWindow->setTitle("Shutter: " + mStage->title());
    return {};
}

void PlayLoop::replaceMissingMethods() {
    for (std::string* method : {&mSettings.method, &mSettings.leftMethod}) {
        if (std::find(mMethods.begin(), mMethods.end(), *method) != mMethods.end())
            continue;
        mMessage = fmt::format(
            "method {} needs rays, which {} cannot trace: gather instead",
            *method,
            mDevice->info().name
        );
        core::logWarning("{}", mMessage);
        *method = "gather";
    }
}

core::Status PlayLoop::run() {
    while (!mQuit)
        if (core::Status done = advance(); !done)
            return done;
    return finish();
}

core::Status PlayLoop::openFilm() {
    if (mOptions.film.empty())
        return {};
    const double fps = mScript ? 1.0 / mScript->frameSeconds() : mOptions.fps;
    auto film = FilmWriter::open(mOptions.film, mOptions.ffmpeg, fps);
    if (!film)
        return film.error();
    mFilm = std::move(film).value();
    return {};
}

core::Status PlayLoop::finish() {
    mRenderer->finishAll();
    if (core::Status taken = takePictures(); !taken)
        return taken;
    if (mFilm)
        if (core::Status made = mFilm->finish(); !made)
            return made;
    if (mRecorder.isRecording())
        toggleRecording();
    if (!mOptions.stats.empty()) {
        const math::uvec2 size = windowSize();
        SessionFacts facts{mStage->title(), mDevice->info().name, mSettings.method, size};
        facts.score = mStage->score();
        facts.isOver = mStage->isOver();
        releaseDrawing(); // validation looks at that, too
        facts.validationMessages = mDevice->validationMessageCount();
        if (core::Status written = mRecord.write(mOptions.stats, facts); !written)
            return written;
    }
    releaseDrawing();
    if (const uint32_t messages = mDevice->validationMessageCount(); messages > 0)
        return core::makeError("{} Vulkan validation messages", messages);
    return {};
}

math::uvec2 PlayLoop::windowSize() const {
    return mWindow ? mWindow->framebufferSize() : mHeadlessSize;
}

app::InputCollector& PlayLoop::collector() {
    // What a window hears besides, an absent gamepad too, must not mix with a script.
    return mScript || !mWindow ? mInput : mWindow->input();
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
    // Nobody waits for a film, and nobody looks where there is no window.
    return mFilm || !mWindow ? 1.0 / mOptions.fps : seconds;
}

core::Status PlayLoop::advance() {
    const math::uvec2 size = windowSize();
    const bool hidden = size.x == 0 || size.y == 0;
    if (mWindow)
        mWindow->poll(hidden && !mScript);
    applyScript();
    mQuit = mQuit || (mWindow && mWindow->closeRequested());
    const double wallSeconds = measureFrame();
    app::InputState input = collector().take();
    if (hidden) { // the game rests with it
        if (mScript)
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        return {};
    }
    PanelWishes wishes;
    drawPanel(input, wallSeconds, wishes);
    grant(wishes);
    input = filterInput(input);
    mTime = mClock.advance(wallSeconds);
    mStage->advance(input, {mTime, wallSeconds, double(size.y), mClock.isPaused()});
    if (core::Status drawn = drawPicture(mTime.duration); !drawn)
        return drawn;
    if (mOptions.frames > 0 && mRecord.pictureCount() >= mOptions.frames)
        mQuit = true;
    return takePictures();
}

void PlayLoop::applyScript() {
    if (!mScript)
        return;
    const math::uvec2 size = glm::max(windowSize(), math::uvec2(1u));
    for (const app::ScriptEvent& event : mScript->takeFrame(collector(), size)) {
        if (const auto* resize = std::get_if<app::ResizeEvent>(&event.what)) {
            mHeadlessSize = resize->size;
            if (mWindow)
                mWindow->resize(resize->size.x, resize->size.y);
        } else if (const auto* action = std::get_if<app::WindowAction>(&event.what)) {
            applyWindowAction(*action);
        } else if (const auto* shot = std::get_if<app::ScreenshotEvent>(&event.what)) {
            mScreenshots.push_back(shot->file);
        }
    }
    if (mScript->isOver())
        mQuit = true;
}

void PlayLoop::applyWindowAction(app::WindowAction action) {
    if (action == app::WindowAction::Quit)
        mQuit = true;
    if (!mWindow)
        return;
    switch (action) {
    case app::WindowAction::Minimise:
        mWindow->minimise();
        break;
    case app::WindowAction::Restore:
        mWindow->restore();
        break;
    case app::WindowAction::FullScreen:
    case app::WindowAction::Windowed:
        mWindow->setFullScreen(action == app::WindowAction::FullScreen);
        break;
    case app::WindowAction::Quit:
        break;
    }
}

app::InputState PlayLoop::filterInput(const app::InputState& input) {
    dragDivider(input);
    app::InputState left = input;
    if (mUi->wantsPointer() || mDraggingDivider) {
        left.buttons.reset();
        left.clicked.reset();
        left.wheel = 0.0;
    }
    if (mUi->wantsKeys()) {
        left.down.reset();
        left.pressed.reset();
    }
    return left;
}

void PlayLoop::dragDivider(const app::InputState& input) {
    const double width = std::max(windowSize().x, 1u);
    const double atPx = mSettings.dividerShare * width;
    const bool grabs = mSettings.split && !mUi->wantsPointer() &&
                       input.wasClicked(app::MouseButton::Left) &&
                       std::abs(input.pointerPx.x - atPx) <= kGrabPx;
    mDraggingDivider =
        input.isDown(app::MouseButton::Left) && (grabs || mDraggingDivider) && mSettings.split;
    if (mDraggingDivider)
        mSettings.dividerShare = std::clamp(input.pointerPx.x / width, 0.0, 1.0);
}

void PlayLoop::drawPanel(const app::InputState& input, double wallSeconds, PanelWishes& wishes) {
    const math::uvec2 size = windowSize();
    mUi->begin(input, size, mWindow ? mWindow->contentScale() : 1.0, wallSeconds);
    const std::vector<HudLine> hud = mStage->hud();
    PanelFacts facts;
    facts.title = mStage->title();
    facts.hud = hud;
    facts.message = mMessage;
    if (!mFilm) { // times differ from one session to the next, a film's pictures do not
        facts.right = mRenderer->statistics(PlaySide::Right);
        facts.left = mSettings.split ? mRenderer->statistics(PlaySide::Left) : nullptr;
        facts.frameMilliseconds = mRecord.meanMilliseconds();
    }
    facts.pictureSize = scaledSize(size, mSettings.resolutionScale);
    facts.exposure = mExposure;
    facts.paused = mClock.isPaused();
    facts.speed = mClock.speed();
    facts.recording = mRecorder.isRecording();
    facts.methods = mMethods;
    facts.views = mViews;
    wishes = mPanel.draw(facts, mSettings);
    mUi->end();
    if (mUi->wantsKeys())
        return;
    PanelWishes keys = applyHotkeys(input, {mMethods, mViews}, mClock.speed(), mSettings);
    wishes.save = wishes.save || keys.save;
    wishes.load = wishes.load || keys.load;
    wishes.togglePause = wishes.togglePause || keys.togglePause;
    wishes.singleStep = wishes.singleStep || keys.singleStep;
    wishes.toggleRecording = wishes.toggleRecording || keys.toggleRecording;
    wishes.toggleFullScreen = wishes.toggleFullScreen || keys.toggleFullScreen;
    wishes.quit = wishes.quit || keys.quit;
    if (keys.speed)
        wishes.speed = keys.speed;
}

void PlayLoop::grant(const PanelWishes& wishes) {
    mQuit = mQuit || wishes.quit;
    if (wishes.togglePause)
        mClock.setPaused(!mClock.isPaused());
    if (wishes.speed)
        mClock.setSpeed(*wishes.speed);
    if (wishes.singleStep) {
        mClock.setPaused(true);
        mClock.stepOnce(kSingleStepSeconds);
    }
    if (wishes.toggleFullScreen && mWindow)
        mWindow->setFullScreen(!mWindow->isFullScreen());
    if (wishes.save)
        saveSettings();
    if (wishes.load)
        loadSettings();
    if (wishes.toggleRecording)
        toggleRecording();
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

void PlayLoop::saveSettings() {
    if (mSettingsFile.empty()) {
        mMessage = "settings are kept nowhere: there is no home folder, or a script plays";
        return;
    }
    std::error_code ignored;
    if (mOptions.settings.empty())
        std::filesystem::create_directories(mSettingsFile.parent_path(), ignored);
    if (mSettingsRefused) {
        mMessage =
            mSettingsFile.string() + " is not written over: it was refused and holds a mistake";
        return;
    }
    const core::Status saved = savePlaySettings(mSettingsFile, mSettings);
    mMessage = saved ? "saved " + mSettingsFile.string() : saved.error().message;
}

void PlayLoop::refuseSettings(const std::string& why) {
    mSettingsRefused = true;
    mMessage = why;
    core::logWarning("{}", why);
}

void PlayLoop::loadSettings() {
    if (mSettingsFile.empty())
        return;
    auto loaded = loadPlaySettings(mSettingsFile);
    if (!loaded) {
        refuseSettings(loaded.error().message);
        return;
    }
    mMessage = "loaded " + mSettingsFile.string();
    mSettingsRefused = false;
    mSettings = std::move(loaded).value();
    replaceMissingMethods();
}

bool PlayLoop::fitSwapchain(const math::uvec2& size) {
    const gpu::SwapchainDesc& now = mSwapchain->desc();
    if (now.width == size.x && now.height == size.y && now.vsync == mSettings.vsync)
        return true;
    mRenderer->finishAll();
    return mSwapchain->resize({size.x, size.y, mSettings.vsync});
}

void PlayLoop::chooseExposure(double duration) {
    scene::World& world = mStage->world();
    // A scene's own clock may start elsewhere than the game's.
    const double now = mTime.seconds + mStage->startSeconds();
    scene::CameraShutter shutter = makeShutter(mSettings);
    mStage->adjustShutter(now, shutter);
    world.registry.add(mStage->camera(), shutter);
    mExposure = scene::computeExposure(shutter, now, duration);
    // What is simulated is known up to now: an exposure that would go on is drawn later.
    if (mExposure.close > now)
        mExposure =
            scene::computeExposure(shutter, now - (mExposure.close - mExposure.raster), duration);
}

core::Status PlayLoop::drawPicture(double duration) {
    math::uvec2 size = windowSize();
    if (size.x == 0 || size.y == 0)
        return {};
    mRenderer->makeRoom(mSettings);
    std::optional<gpu::SwapchainImage> shown;
    if (mSwapchain) {
        if (fitSwapchain(size))
            shown = mSwapchain->acquire();
        if (!shown) { // between two sizes, or out of sight
            mRenderer->finishAll();
            mSwapchain->resize({size.x, size.y, mSettings.vsync});
            return {};
        }
        size = {mSwapchain->desc().width, mSwapchain->desc().height};
    }
    scene::World& world = mStage->world();
    const ecs::Entity camera = mStage->camera();
    chooseExposure(duration);
    mRecorder.addFrame(world, camera, mExposure.raster);
    const math::uvec2 drawn = scaledSize(size, mSettings.resolutionScale);
    const DemoLook look = mStage->look();
    PlayPicture picture;
    picture.view.camera = camera;
    picture.view.exposure = mExposure;
    picture.view.width = drawn.x;
    picture.view.height = drawn.y;
    picture.view.background = look.background;
    picture.view.ambient = look.ambient;
    picture.window.size = size;
    picture.window.overlay = mUi.get();
    picture.wantReasons = mSettings.showPanel;
    if (shown) {
        picture.window.image = shown->image;
        picture.semaphores = shown->semaphores;
    }
    picture.readBack = mFilm || !mScreenshots.empty();
    if (picture.readBack && mSwapchain && !mSwapchain->canBeRead())
        return core::makeError("this display's pictures cannot be read: no film, no screenshots");
    if (core::Status done = mRenderer->draw(world, picture, mSettings); !done)
        return done;
    if (shown && !mSwapchain->present(*shown)) {
        mRenderer->finishAll();
        mSwapchain->resize({size.x, size.y, mSettings.vsync});
    }
    // One read-back serves all files of the frame; empty names end a picture's list.
    for (const auto& file : std::exchange(mScreenshots, {}))
        mWantedFiles.push_back(file);
    if (picture.readBack)
        mWantedFiles.emplace_back();
    mHasDrawn = true;
    mRecord.addPicture(std::chrono::duration<double>(Clock::now() - mStart).count());
    if (const auto* statistics = mRenderer->statistics(PlaySide::Right))
        mRecord.addStatistics(*statistics);
    return {};
}

core::Status PlayLoop::takePictures() {
    while (const auto picture = mRenderer->takePicture()) {
        image::Image opaque(picture->width, picture->height, 3);
        for (size_t i = 0; i < size_t(picture->width) * picture->height; ++i)
            std::copy_n(&picture->pixels[4 * i], 3, &opaque.pixels[3 * i]);
        if (core::Status written = writePicture(opaque); !written)
            return written;
    }
    return {};
}

core::Status PlayLoop::writePicture(const image::Image& picture) {
    while (!mWantedFiles.empty()) {
        const std::filesystem::path file = std::move(mWantedFiles.front());
        mWantedFiles.pop_front();
        if (file.empty())
            break;
        if (core::Status written = io::writeImage(file, picture); !written)
            return written;
    }
    return mFilm ? mFilm->add(picture) : core::Status();
}

} // namespace shutter::game
