// SPDX-License-Identifier: MIT
// What a better picture costs, in a sentence of computed figures; then the methods as a ladder.

/** The two methods that the headline compares: as the results name them, else hybrid and gather. */
function headlineMethods() {
    return results.headline ?? {method: "hybrid", baseline: "gather"};
}

function findHeadlinePair() {
    const {method, baseline} = headlineMethods();
    const cases = results.cases.filter((c) => defaultOf(c, method) && defaultOf(c, baseline));
    return cases.length > 0 ? {method, baseline, cases} : null;
}

function comparePair({method, baseline, cases}, metric) {
    const pairs = cases.map((c) => [defaultOf(c, method), defaultOf(c, baseline)]);
    const gains = pairs.map(([a, b]) => gain(metric, metricOf(a, metric), metricOf(b, metric)))
        .filter(Number.isFinite);
    const ratios = pairs.map(([a, b]) =>
        a.milliseconds.frame.median / b.milliseconds.frame.median);
    return {
        gain: median(gains),
        wins: gains.filter((g) => g > 0).length,
        count: gains.length,
        ratio: median(ratios),
    };
}

/** "31.6 dB", "0.024 FLIP" */
function formatShort(metric, value) {
    const decimals = metric.unit === "dB" ? 1 : 3;
    return withUnit(formatNumber(value, decimals), metric.unit || metric.name);
}

/** "hybrid gains 1.3 dB over gather for 1.6× its time" */
function writePairSentence(pair, metric) {
    const {gain: gained, wins, count, ratio} = comparePair(pair, metric);
    if (count === 0) return null;
    const amount = formatShort(metric, Math.abs(gained));
    const verb = gained >= 0 ? "gains" : "loses";
    const towards = gained >= 0 ? "over" : "to";
    const times = formatRatio(ratio);
    if (pair.cases.length === 1) {
        return `${pair.method} ${verb} ${amount} ${towards} ${pair.baseline} for ${times} ` +
            "its time.";
    }
    return `Over ${count} cases, ${pair.method} ${verb} a median of ${amount} ${towards} ` +
        `${pair.baseline} (better in ${wins}) for ${times} its time.`;
}

function writeScalingSentence() {
    const axis = results.scaling?.[0];
    const wanted = headlineMethods().method;
    const series = axis?.series.find((s) => s.method === wanted) ?? axis?.series[0];
    if (!series) return null;
    const first = series.points[0];
    const last = series.points.at(-1);
    const growth = last.milliseconds.frame.median / first.milliseconds.frame.median;
    const fit = series.fit?.frame
        ? `, as ${axis.unit} to the power of ${formatNumber(series.fit.frame.exponent, 2)}` : "";
    return `From ${first.label} to ${last.label}, the time of ${series.method} grows ` +
        `${formatRatio(growth)}${fit}.`;
}

/** {method, samples, time, value} of all measurements in the pair's one case, or the medians. */
function listRivals(pair, metric) {
    if (pair.cases.length > 1) {
        return summarize(pair.cases).map((row) => ({
            method: row.method.name, samples: row.samples, time: row.time,
            value: row.metrics[metric.id],
        }));
    }
    return pair.cases[0].measurements.map((m) => ({
        method: m.method, samples: m.samples, time: m.milliseconds.frame.median,
        value: metricOf(m, metric),
    }));
}

/** Where there is no pair to compare. */
function writeCountSentence() {
    const count = results.cases.reduce((sum, c) => sum + c.measurements.length, 0);
    return count > 0
        ? `${countOf(count, "measurement")} over ${countOf(results.cases.length, "case")}.`
        : "No figures were taken.";
}

/** What it costs to come closer than the headline's method. */
function writeNextSentence(pair, metric) {
    const {method} = pair;
    const found = pair.cases.map((c) => defaultOf(c, method));
    const value = median(found.map((m) => metricOf(m, metric)));
    const time = median(found.map((m) => m.milliseconds.frame.median));
    const better = listRivals(pair, metric).filter((rival) => rival.method !== method &&
        !truthMethods.has(rival.method) && isBetter(metric, rival.value, value));
    better.sort((a, b) => a.time - b.time);
    const [next] = better;
    if (!next) return `No other method measured comes closer to the truth than ${method}.`;
    const reached = Number.isFinite(next.value)
        ? `reaches ${formatShort(metric, next.value)}` : "equals the truth";
    return `The cheapest other method that comes closer, ` +
        `${nameMeasurement(next.method, next.samples)}, ${reached} for ` +
        `${formatRatio(next.time / time)} the time of ${method}.`;
}

/** What distributed rays reach in the time of the equal-time reference. */
function writeEqualTimeSentence(metric) {
    const entries = (results.equalTime ?? []).map(({reference, rows}) =>
        ({reference, row: rows.find((r) => r.method === "truth")})).filter(({row}) => row);
    if (entries.length === 0 || truthMethods.has("truth")) return "";
    const [{reference, row}] = entries;
    const value = median(entries.map((entry) => metricOf(entry.row, metric)));
    const amount = nameSamples(row.method, median(entries.map((entry) => entry.row.samples)));
    const ratio = median(entries.map((entry) =>
        entry.row.milliseconds / entry.reference.milliseconds));
    const reached = formatShort(metric, value);
    return ratio > 1.25
        ? ` Even ${amount} per pixel of truth takes ${formatRatio(ratio)} the time of ` +
            `${reference.method}, and reaches ${reached}.`
        : ` In the time of ${reference.method}, truth traces ${amount} per pixel and reaches ` +
            `${reached}.`;
}

function drawHeadline() {
    const metric = results.metrics[0];
    const pair = metric && findHeadlinePair();
    const pairSentence = pair && writePairSentence(pair, metric);
    const headline = pairSentence ?? writeScalingSentence() ?? writeSequenceSentence() ??
        writeCountSentence();
    const {width, height} = results.settings;
    byId("overline").textContent = [
        `Shutter benchmark, suite ${results.suite}`,
        `${width}×${height}`,
        results.device.name,
    ].join(" · ");
    byId("headline").textContent = headline;
    document.title = `Shutter benchmark: ${results.suite}`;
    const lede = pairSentence
        ? writeNextSentence(pair, metric) + writeEqualTimeSentence(metric) : "";
    byId("lede").textContent = lede;
    byId("lede").hidden = lede === "";
    byId("incomplete").hidden = results.complete;
    byId("incomplete").textContent =
        "This run was stopped before its end: measurements are missing, and figures may change.";
}

/** A marker on a line from `low` to `high`; positions in 0 to 1. */
function makeStrip(position, methodName) {
    if (!Number.isFinite(position)) return el("span", {class: "strip"});
    const mark = el("span", {class: "dot"}, markIcon(methodName));
    mark.style.left = `${(position * 100).toFixed(2)}%`;
    return el("span", {class: "strip"}, mark);
}

/** Methods that have no row because their default was skipped in some case, with the reason. */
function listSkippedDefaults(rows) {
    const found = [];
    for (const method of results.methods) {
        const skipped = results.cases.flatMap((theCase) => theCase.skipped ?? []).find((one) =>
            one.method === method.name && one.samples === method.default);
        if (skipped && !rows.some((row) => row.method === method)) {
            found.push({method, reason: skipped.reason});
        }
    }
    return found;
}

/** Maps values to 0 to 1 between the least and the greatest. */
function makeScale(values, logarithmic) {
    const usable = values.filter((v) => Number.isFinite(v) && (!logarithmic || v > 0));
    const warp = logarithmic ? Math.log : (v) => v;
    const low = warp(Math.min(...usable));
    const high = warp(Math.max(...usable));
    return (value) => {
        if (value === Number.POSITIVE_INFINITY) return 1;
        if (!Number.isFinite(value) || (logarithmic && value <= 0)) return Number.NaN;
        return high > low ? (warp(value) - low) / (high - low) : 0.5;
    };
}

function drawLadder() {
    const rows = summarize(results.cases);
    const metric = chosen.metric;
    if (rows.length < 2 || !metric) return;
    reveal("ladder");
    const many = results.cases.length > 1;
    byId("ladder-note").textContent = `Each method at its default sample count, fastest first` +
        `${many ? `, medians over ${results.cases.length} cases` : ""}. ` +
        `Time on a logarithmic line, ${metric.name} on a linear one. The Pareto front holds ` +
        "those that no other here beats in both.";
    const points = rows.map((row) => ({...row, value: row.metrics[metric.id]}));
    const isRanked = (row) => !truthMethods.has(row.method.name);
    const front = new Set(findParetoFront(points.filter(isRanked), metric).map((p) => p.method));
    const timeScale = makeScale(rows.map((row) => row.time), true);
    const ranked = rows.filter(isRanked).map((row) => row.metrics[metric.id]);
    const metricScale = makeScale(ranked, false);
    const others = results.metrics.filter((m) => m !== metric);
    const fastest = rows.find((row) => row.time > 0)?.time;
    const columns = ["Method", {content: "ms", class: "n"}, {content: "×", class: "n"},
        {content: chosen.time === "frame" ? "Frame time" : "Time of the effect", class: "wide"},
        {content: withUnit(metric.name, metric.unit), class: "n"},
        {content: `${metric.better} is better`, class: "wide"},
        ...others.map((m) => ({content: m.name, class: "n"})), "Front"];
    const body = rows.map((row) => [
        {content: methodLabel(row.method.name, row.samples)},
        {content: formatMs(row.time), class: "n"},
        {content: row.time > 0 ? formatRatio(row.time / fastest) : "–", class: "n soft"},
        {content: makeStrip(timeScale(row.time), row.method.name), class: "wide"},
        {content: formatMetric(metric, row.metrics[metric.id]), class: "n"},
        {content: isRanked(row)
            ? makeStrip(metricScale(row.metrics[metric.id]), row.method.name)
            : "it made the truth", class: "wide soft"},
        ...others.map((m) => ({content: formatMetric(m, row.metrics[m.id]), class: "n"})),
        {content: front.has(row.method) ? "yes" : "", class: "soft"},
    ]);
    const dash = {content: "–", class: "n soft"};
    const absent = listSkippedDefaults(rows).map(({method, reason}) => [
        {content: methodLabel(method.name, method.default)}, dash, dash,
        {content: "", class: "wide"}, dash, {content: `not measured: ${reason}`, class: "wide soft"},
        ...others.map(() => dash), "",
    ]);
    byId("ladder-table").replaceChildren(
        makeTable(columns, [...body, ...absent], {class: "ladder"}));
}
