// SPDX-License-Identifier: MIT
// What a better picture costs, in a sentence of computed figures; then the methods as a ladder.

/** The two methods that the headline compares: as the results say, else hybrid and gather. */
function findHeadlinePair() {
    const {method, baseline} = results.headline ?? {method: "hybrid", baseline: "gather"};
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

/** "hybrid gains 1.3 dB over gather for 1.6× its time" */
function writePairSentence(pair, metric) {
    const {gain: gained, wins, count, ratio} = comparePair(pair, metric);
    if (count === 0) return null;
    const decimals = metric.unit === "dB" ? 1 : 3;
    const amount = withUnit(formatNumber(Math.abs(gained), decimals), metric.unit || metric.name);
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
    const wanted = results.headline?.method ?? "hybrid";
    const series = axis?.series.find((s) => s.method === wanted) ?? axis?.series[0];
    if (!series) return null;
    const first = series.points[0];
    const last = series.points.at(-1);
    const growth = last.milliseconds.median / first.milliseconds.median;
    const fit = series.fit
        ? `, as ${axis.unit} to the power of ${formatNumber(series.fit.exponent, 2)}` : "";
    return `From ${first.label} to ${last.label}, the time of ${series.method} grows ` +
        `${formatRatio(growth)}${fit}.`;
}

/** What the best picture costs beyond the headline's method. */
function writeBestSentence(pair, metric) {
    const rows = summarize(pair.cases);
    const from = rows.find((row) => row.method.name === pair.method);
    const better = rows.filter((row) =>
        from && isBetter(metric, row.metrics[metric.id], from.metrics[metric.id]));
    better.sort((a, b) => gain(metric, b.metrics[metric.id], a.metrics[metric.id]));
    const best = better[0];
    if (!best) return `At its own setting, no other method is closer to the truth than ${pair.method}.`;
    const value = best.metrics[metric.id];
    const name = nameMeasurement(best.method.name, best.dial);
    const result = Number.isFinite(value)
        ? `reaches ${withUnit(formatNumber(value, metric.unit === "dB" ? 1 : 3), metric.unit)}`
        : "equals the truth";
    return `The best picture at the methods' own settings, ${name}, ${result} and takes ` +
        `${formatRatio(best.time / from.time)} the time of ${pair.method}.`;
}

function drawHeadline() {
    const metric = results.metrics[0];
    const pair = metric && findHeadlinePair();
    const pairSentence = pair && writePairSentence(pair, metric);
    const headline = pairSentence ?? writeScalingSentence() ?? "No figures were taken.";
    const {width, height} = results.settings;
    byId("overline").textContent = [
        `Shutter benchmark, suite ${results.suite}`, `${width}×${height}`, results.device.name,
    ].join(" · ");
    byId("headline").textContent = headline;
    document.title = `Shutter benchmark: ${results.suite}`;
    const lede = pairSentence ? writeBestSentence(pair, metric) : "";
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
    byId("ladder-note").textContent = `Each method at its default dial, fastest first` +
        `${many ? `, medians over ${results.cases.length} cases` : ""}. ` +
        `Time on a logarithmic line, ${metric.name} on a linear one; on the Pareto front stand ` +
        "those that no other here beats in both.";
    const points = rows.map((row) => ({...row, value: row.metrics[metric.id]}));
    const front = new Set(findParetoFront(points, metric).map((p) => p.method));
    const timeScale = makeScale(rows.map((row) => row.time), true);
    const metricScale = makeScale(rows.map((row) => row.metrics[metric.id]), false);
    const others = results.metrics.filter((m) => m !== metric);
    const fastest = rows.find((row) => row.time > 0)?.time;
    const columns = ["Method", {content: "ms", class: "n"}, {content: "×", class: "n"},
        {content: chosen.time === "frame" ? "Frame time" : "Time of the effect", class: "wide"},
        {content: withUnit(metric.name, metric.unit), class: "n"},
        {content: `${metric.better} is better`, class: "wide"},
        ...others.map((m) => ({content: m.name, class: "n"})), "Front"];
    const body = rows.map((row) => [
        {content: methodLabel(row.method.name, row.dial)},
        {content: formatMs(row.time), class: "n"},
        {content: row.time > 0 ? formatRatio(row.time / fastest) : "–", class: "n soft"},
        {content: makeStrip(timeScale(row.time), row.method.name), class: "wide"},
        {content: formatMetric(metric, row.metrics[metric.id]), class: "n"},
        {content: makeStrip(metricScale(row.metrics[metric.id]), row.method.name),
            class: "wide"},
        ...others.map((m) => ({content: formatMetric(m, row.metrics[m.id]), class: "n"})),
        {content: front.has(row.method) ? "yes" : "", class: "soft"},
    ]);
    byId("ladder-table").replaceChildren(makeTable(columns, body, {class: "ladder"}));
}
