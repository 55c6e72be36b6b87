// SPDX-License-Identifier: MIT
// Two films of one sequence in step: one clock determines which frame is due, and both are taken to it.

const player = {
    left: null, right: null, // ids of films
    frame: 0, // due
    shown: null, // that both films show; null: they are being loaded
    loads: 0, // how often films were changed
    isSeeking: false,
    isPlaying: false,
    speed: 1,
    zoom: 1, x: 0, y: 0, // x, y: of the point in the upper left corner, shares of the picture
    isOver: false, // one film over the other, with a line between them
    split: 50,
};
const kLargestZoom = 16;
const kLongestWaitMs = 1000;

/** Films of the watched sequence: the truth's, then the methods'. */
function listFilms() {
    const sequence = watched.sequence;
    if (!sequence) return [];
    const films = sequence.measurements.map((m) => (
        {id: nameMeasurement(m.method, m.samples), method: m.method, file: m.film}));
    return [{id: "truth", method: null, file: sequence.truth.film}, ...films]
        .filter(({file}) => file !== undefined);
}

function videos() {
    return [byId("player-left-film"), byId("player-right-film")];
}

function once(target, type) {
    return new Promise((resolve) => { target.addEventListener(type, resolve, {once: true}); });
}

/** In the middle of the frame, so that no rounding of its times leads to another. */
function timeOfFrame(frame) {
    return (frame + 0.5) / watched.sequence.framesPerSecond;
}

/** When a film has put the frame on the screen; a hidden page puts none, and nobody waits for it. */
function presented(video, frame) {
    return new Promise((resolve) => {
        setTimeout(resolve, kLongestWaitMs);
        if (!video.requestVideoFrameCallback) return;
        const checkFrame = (_now, {mediaTime}) => {
            const shown = mediaTime * watched.sequence.framesPerSecond;
            if (Math.abs(shown - frame) < 0.5) resolve();
            else video.requestVideoFrameCallback(checkFrame);
        };
        video.requestVideoFrameCallback(checkFrame);
    });
}

async function seek(video, frame) {
    if (video.readyState < HTMLMediaElement.HAVE_METADATA) await once(video, "loadedmetadata");
    // Another film in its place never ends the search.
    const sought = Promise.race([once(video, "seeked"), once(video, "emptied")]);
    const arrival = presented(video, frame);
    video.currentTime = timeOfFrame(frame);
    await sought;
    await arrival;
}

/** Shows a frame in both films; where the reader is faster than the films, the last one chosen. */
async function showFrame(frame) {
    const {frames} = watched.sequence;
    player.frame = Math.min(Math.max(frame, 0), frames - 1);
    if (player.isSeeking) return;
    player.isSeeking = true;
    while (player.shown !== player.frame) {
        const {frame: due, loads} = player;
        await Promise.all(videos().map((video) => seek(video, due)));
        if (loads !== player.loads) continue;
        player.shown = due;
        noteFrame();
    }
    player.isSeeking = false;
}

function noteFrame() {
    const {frames, framesPerSecond} = watched.sequence;
    byId("player-frame").value = String(player.shown);
    byId("player-place").textContent = `frame ${player.shown} of ${frames}, ` +
        `${formatNumber(player.shown / framesPerSecond, 2)} s`;
    const stage = byId("player-stage");
    stage.dataset.shown = String(player.shown);
    // Listeners run now, before the next frame is sought.
    stage.dispatchEvent(new Event("shown"));
}

function play(isPlaying) {
    player.isPlaying = isPlaying;
    byId("player-play").textContent = isPlaying ? "Pause" : "Play";
    if (!isPlaying) return;
    const {frames, framesPerSecond} = watched.sequence;
    const first = player.frame;
    let start = null;
    const tick = (now) => {
        if (!player.isPlaying) return;
        start ??= now;
        const passed = Math.floor(((now - start) / 1000) * framesPerSecond * player.speed);
        showFrame((first + passed) % frames);
        requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
}

function step(frames) {
    play(false);
    showFrame(player.frame + frames);
}

/** Both films enlarged alike. */
function placeFilms() {
    const room = 1 - 1 / player.zoom;
    player.x = Math.min(Math.max(player.x, 0), room);
    player.y = Math.min(Math.max(player.y, 0), room);
    for (const video of videos()) {
        video.style.transform = `scale(${player.zoom}) ` +
            `translate(${-100 * player.x}%, ${-100 * player.y}%)`;
        video.style.imageRendering = player.zoom > 2 ? "pixelated" : "auto";
    }
    byId("player-zoom").textContent = `${formatNumber(player.zoom, 1)}×`;
}

/** \param at shares of the film's box that keep what they show */
function zoomBy(factor, at = {x: 0.5, y: 0.5}) {
    const zoom = Math.min(Math.max(player.zoom * factor, 1), kLargestZoom);
    player.x += at.x / player.zoom - at.x / zoom;
    player.y += at.y / player.zoom - at.y / zoom;
    player.zoom = zoom;
    placeFilms();
}

function placeSplit(percent) {
    player.split = Math.min(Math.max(percent, 0), 100);
    byId("player-right").style.clipPath = player.isOver ? `inset(0 0 0 ${player.split}%)` : "";
    const handle = byId("player-handle");
    handle.hidden = !player.isOver;
    handle.style.left = `${player.split}%`;
    handle.setAttribute("aria-valuenow", String(Math.round(player.split)));
}

function layOut() {
    byId("player-stage").classList.toggle("over", player.isOver);
    placeSplit(player.split);
}

function loadFilms(films) {
    for (const side of ["left", "right"]) {
        const film = films.find(({id}) => id === player[side]);
        const video = byId(`player-${side}-film`);
        byId(`player-${side}-name`).textContent = film.id;
        if (video.dataset.file === film.file) continue;
        video.dataset.file = film.file;
        video.src = filmFiles[film.file];
        player.shown = null;
        ++player.loads;
        delete byId("player-stage").dataset.shown;
    }
    showFrame(player.frame);
}

function drawPlayer() {
    const films = listFilms();
    byId("player").hidden = films.length < 2;
    if (films.length < 2) return;
    const pick = (id, method, fallback) => (films.find((film) => film.id === id) ??
        films.find((film) => film.method === method) ?? fallback).id;
    player.left = pick(player.left, results.headline?.method, films[1]);
    player.right = pick(player.right, undefined, films[0]);
    const options = films.map(({id}) => ({value: id, label: id}));
    fillSelect(byId("player-left-choice"), options, player.left);
    fillSelect(byId("player-right-choice"), options, player.right);
    byId("player-frame").max = String(watched.sequence.frames - 1);
    loadFilms(films);
    layOut();
    placeFilms();
}

/** A pointer's place as shares of the film's box below it, of the left one's outside of both. */
function placeInFilm(event) {
    const box = event.target.closest(".film")?.getBoundingClientRect() ??
        byId("player-left").getBoundingClientRect();
    return {x: (event.clientX - box.left) / box.width, y: (event.clientY - box.top) / box.height};
}

function listenToStage() {
    const stage = byId("player-stage");
    stage.addEventListener("wheel", (event) => {
        if (!event.ctrlKey && !event.shiftKey && document.activeElement !== stage) return;
        zoomBy(2 ** (-event.deltaY / 240), placeInFilm(event));
        event.preventDefault();
    }, {passive: false});
    let grabbed = null;
    stage.addEventListener("pointerdown", (event) => {
        if (event.button !== 0) return;
        grabbed = {isLine: event.target === byId("player-handle")};
        stage.setPointerCapture(event.pointerId);
        stage.focus({preventScroll: true});
        event.preventDefault();
    });
    stage.addEventListener("pointermove", (event) => {
        if (!grabbed) return;
        const at = placeInFilm(event);
        if (grabbed.isLine) {
            placeSplit(100 * at.x);
            return;
        }
        const last = grabbed.last ?? at;
        player.x -= (at.x - last.x) / player.zoom;
        player.y -= (at.y - last.y) / player.zoom;
        grabbed.last = at;
        placeFilms();
    });
    for (const type of ["pointerup", "pointercancel"])
        stage.addEventListener(type, () => { grabbed = null; });
    stage.addEventListener("keydown", (event) => {
        const actions = {
            " ": () => play(!player.isPlaying),
            ArrowLeft: () => step(-1), ArrowRight: () => step(1),
            Home: () => step(-player.frame), End: () => step(watched.sequence.frames),
            "+": () => zoomBy(2), "-": () => zoomBy(0.5), 0: () => zoomBy(1 / player.zoom),
        };
        const action = actions[event.key];
        if (!action || event.target !== stage) return;
        action();
        event.preventDefault();
    });
}

function startPlayer() {
    for (const side of ["left", "right"])
        byId(`player-${side}-choice`).addEventListener("change", (event) => {
            player[side] = event.target.value;
            drawPlayer();
        });
    byId("player-play").addEventListener("click", () => play(!player.isPlaying));
    byId("player-back").addEventListener("click", () => step(-1));
    byId("player-forward").addEventListener("click", () => step(1));
    byId("player-frame").addEventListener("input", (event) => {
        play(false);
        showFrame(Number(event.target.value));
    });
    byId("player-speed").addEventListener("change", (event) => {
        player.speed = Number(event.target.value);
        if (player.isPlaying) play(true);
    });
    byId("player-nearer").addEventListener("click", () => zoomBy(2));
    byId("player-farther").addEventListener("click", () => zoomBy(0.5));
    byId("player-over").addEventListener("change", (event) => {
        player.isOver = event.target.checked;
        layOut();
    });
    byId("player-handle").addEventListener("keydown", (event) => {
        const moves = {ArrowLeft: -1, ArrowRight: 1, Home: -100, End: 100};
        if (!(event.key in moves)) return;
        placeSplit(player.split + moves[event.key]);
        event.preventDefault();
    });
    listenToStage();
    drawPlayer();
}
