// SPDX-License-Identifier: MIT
// Films judged in time: measures by method, the time that an error costs, and curves over frames.

const sequences = results.sequences ?? [];
const temporalMetrics = results.temporalMetrics ?? [];
const kTemporalDecimals = {psnr: 2, ssim: 4, flip: 4, hdrFlip: 4};

/** What the page shows; `hidden`: methods that the curves leave out. */
const watched = {sequence: sequences[0] ?? null, metric: "psnr", hidden: new Set()};

function formatTemporal(id, value) {
    if (value === null) return "∞";
    return formatNumber(value ?? Number.NaN, kTemporalDecimals[id] ?? 5);
}

/** "resolved flickers 4.2× less than gather": medians over the sequences. Null in other suites. */
function writeSequenceSentence() {
    if (sequences.length === 0) return null;
    const flickerOf = (name) => median(sequences.map((film) =>
        film.measurements.find((m) => m.method === name)?.metrics.flicker).filter(Number.isFinite));
    const {method, baseline} = results.headline ?? {};
    const [ours, theirs] = [flickerOf(method), flickerOf(baseline)];
    const over = `over ${countOf(sequences.length, "sequence")}`;
    if (!(ours > 0) || !(theirs > 0)) return `Methods in time, ${over}.`;
    const [calm, other, factor] = ours <= theirs
        ? [method, baseline, theirs / ours] : [baseline, method, ours / theirs];
    return `${calm} flickers ${formatRatio(factor)} less than ${other}, ${over}.`;
}

/** The best value of a measure among measurements; ties are all the best. */
function isBestOf(metric, measurement, all) {
    const values = all.map((m) => m.metrics[metric.id]).filter(Number.isFinite);
    const best = metric.better === "higher" ? Math.max(...values) : Math.min(...values);
    return measurement.metrics[metric.id] === best;
}

function makeMeasureTable(film) {
    const columns = ["Method", {content: "frame, ms", class: "n"},
        ...temporalMetrics.map((metric) => ({
            content: withUnit(metric.name, metric.unit && `(${metric.unit})`), class: "n",
            title: describeMetric(metric),
        }))];
    const rows = film.measurements.map((m) => [
        {content: methodLabel(m.method, m.samples)},
        {content: formatMs(m.milliseconds.frame.median), class: "n"},
        ...temporalMetrics.map((metric) => ({
            content: formatTemporal(metric.id, m.metrics[metric.id]),
            class: isBestOf(metric, m, film.measurements) ? "n better" : "n",
        }))]);
    return makeTable(columns, rows, {class: "checks"});
}

/** Rows by rising time of the first error; methods that miss it come last. */
function makeErrorTable(film) {
    const errors = film.equalError ?? [];
    if (errors.length === 0) return null;
    const columns = ["Method", ...errors.map(({psnr}) => ({
        content: `time for ${formatNumber(psnr, 0)} dB`, class: "n",
    }))];
    const cellOf = (row) => (row.milliseconds === null
        ? {content: `reaches ${formatTemporal("psnr", row.psnr)} dB`, class: "n soft"}
        : {content: `${formatMs(row.milliseconds)} ms` +
            (row.samples === null ? "" : ` (${nameSamples(row.method, row.samples)})`), class: "n"});
    const rowOf = (name, {rows}) => rows.find((row) => row.method === name);
    const costOf = (row) => row.milliseconds ?? Number.POSITIVE_INFINITY;
    const names = [...errors[0].rows].sort((a, b) => costOf(a) - costOf(b) ||
        (b.psnr ?? 0) - (a.psnr ?? 0)).map((row) => row.method);
    return makeTable(columns, names.map((name) => [{content: methodLabel(name)},
        ...errors.map((each) => cellOf(rowOf(name, each)))]));
}

function drawSequenceLegend(film) {
    const isHidden = (m) => watched.hidden.has(m.method);
    byId("sequences-legend").replaceChildren(...film.measurements.map((m) => el("button", {
        type: "button", "data-method": m.method, "aria-pressed": String(!isHidden(m)),
        onclick: () => {
            if (!watched.hidden.delete(m.method)) watched.hidden.add(m.method);
            drawSequenceCurves();
            byId("sequences-legend").querySelector(`[data-method="${m.method}"]`).focus();
        },
    }, markIcon(m.method), m.method)));
}

/** Frames without a value, the first of a difference or one equal to its truth, are left out. */
function drawSequenceCurves() {
    const film = watched.sequence;
    if (!film) return;
    const metric = temporalMetrics.find(({id}) => id === watched.metric);
    drawSequenceLegend(film);
    const sets = film.measurements.filter((m) => !watched.hidden.has(m.method)).map((m) => ({
        label: m.method, showLine: true, ...styleOf(m.method), pointRadius: 0, pointHitRadius: 8,
        data: m.curves[watched.metric].map((y, x) => ({x, y})).filter(({y}) => y !== null),
    }));
    const canvas = byId("sequences-chart");
    canvas.setAttribute("aria-label", `${metric.name} over the frames of ${film.title}`);
    drawChart(canvas, {
        data: {datasets: sets},
        scales: {
            x: makeAxis("frame", false, [0, film.frames - 1]),
            y: makeAxis(describeMetric(metric), false, metric.better === "higher" ? [] : [0]),
        },
        tooltip: {
            title: ([item]) => `${item.dataset.label}, frame ${item.raw.x}`,
            label: (item) => withUnit(formatTemporal(metric.id, item.raw.y), metric.unit),
        },
        whiskersAlong: "y",
    });
}

function describeSequenceTruth(film) {
    const {instants, maxStepPx, mostInstants} = film.truth;
    const of = `${film.description} ${countOf(film.frames, "frame")} at ` +
        `${formatNumber(film.framesPerSecond, 0)} a second. The truth of each is accumulate with `;
    if (maxStepPx === null) {
        return `${of}${countOf(mostInstants, "instant")}, each at another place in the pixel or the lens.`;
    }
    return of +
        `so many instants that nothing moves farther than ${formatNumber(maxStepPx, 1)} px between ` +
        `two of them, ${countOf(mostInstants, "instant")} at most: ` +
        `${formatNumber(instants.median, 0)} at the median.`;
}

/** HDR-FLIP is dear, and only some frames have it. */
function describeHdrFlip(film) {
    const curve = film.measurements[0]?.curves.hdrFlip ?? [];
    const judged = curve.filter((value) => value !== null).length;
    return judged > 0 ? `HDR-FLIP is the mean over ${judged} of the frames.` : "";
}

function drawSequence() {
    const film = watched.sequence;
    if (!film) return;
    byId("sequences-note").textContent = `${describeSequenceTruth(film)} ${describeHdrFlip(film)}`;
    byId("sequences-table").replaceChildren(makeMeasureTable(film));
    const [first] = film.equalError ?? [];
    byId("sequences-error").replaceChildren(...[makeErrorTable(film)].filter(Boolean));
    byId("sequences-error-note").textContent = first
        ? `The fastest sample count of each method whose ${countOf(first.frames.length, "frame")} ` +
            `(${first.frames.join(", ")}) together are within the error.` : "";
    drawSequenceCurves();
}

function startSequences() {
    if (sequences.length === 0) return;
    reveal("sequences");
    fillSelect(byId("sequence"), sequences.map((film) => ({value: film.name, label: film.title})),
        watched.sequence.name);
    const curves = Object.keys(sequences[0].measurements[0]?.curves ?? {});
    fillSelect(byId("sequence-metric"), temporalMetrics.filter(({id}) => curves.includes(id))
        .map((metric) => ({value: metric.id, label: metric.name})), watched.metric);
    byId("sequence").addEventListener("change", (event) => {
        watched.sequence = sequences.find((film) => film.name === event.target.value);
        drawSequence();
        drawPlayer();
    });
    byId("sequence-metric").addEventListener("change", (event) => {
        watched.metric = event.target.value;
        drawSequenceCurves();
    });
    drawSequence();
}
