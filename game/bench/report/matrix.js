// SPDX-License-Identifier: MIT
// Case by method: each cell's figure, shaded by how far it is from the best of its row.

function findBest(values, metric) {
    return values.reduce((a, b) => (isBetter(metric, a, b) ? a : b), values[0]);
}

function drawMatrix() {
    const metric = chosen.metric;
    if (results.cases.length < 2 || !metric) return;
    reveal("matrix");
    byId("matrix-note").textContent = `${describeMetric(metric)}; every method at its default ` +
        "sample count. The stronger the colour of a cell, the closer it is to the best of its row, " +
        "which is framed. What made the truth is judged by itself and takes no part. " +
        "Choose a case by its name to see it in the other sections.";
    const methods = results.methods.filter((method) =>
        results.cases.some((c) => defaultOf(c, method.name)));
    const gaps = [];
    const rows = results.cases.map((theCase) => {
        const values = methods.map((method) => {
            const found = defaultOf(theCase, method.name);
            return found ? metricOf(found, metric) : Number.NaN;
        });
        const ranked = values.map((value, i) =>
            (methods[i].name === theCase.truth.method ? Number.NaN : value));
        const best = findBest(ranked.filter((v) => !Number.isNaN(v)), metric);
        // An infinite best would put all others infinitely far: they are shaded from the next.
        const top = findBest(ranked.filter(Number.isFinite), metric);
        const distances = ranked.map((v) => Math.max(0, gain(metric, top, v)));
        gaps.push(...distances.filter(Number.isFinite));
        return {theCase, values, best, distances};
    });
    // One outlier must not wash out the rest: the scale ends at twice the median gap.
    const scale = 2 * median(gaps.filter((gap) => gap > 0)) || 1;
    const columns = ["Case", ...methods.map((method) =>
        ({content: methodLabel(method.name), class: "n"}))];
    const body = rows.map(({theCase, values, best, distances}) => [
        {content: el("button", {
            type: "button", class: "link", title: theCase.description,
            "aria-pressed": String(theCase === chosen.case),
            onclick: () => choose({case: theCase}),
        }, theCase.title)},
        ...values.map((value, i) => {
            if (Number.isNaN(distances[i]))
                return {content: formatMetric(metric, value), class: "n soft"};
            const far = distances[i] / scale;
            const strength = value === best ? 1 : Math.max(0, 1 - far);
            return {
                content: formatMetric(metric, value),
                class: value === best ? "n cell best" : "n cell",
                style: `--strength:${strength.toFixed(3)}`,
            };
        }),
    ]);
    byId("matrix-table").replaceChildren(makeTable(columns, body, {class: "matrix"}));
}
