// SPDX-License-Identifier: MIT
// Claims about cost, and about what grows over many frames: curves with their lines, and each check
// beside its bound.

/** "6 of 7 claims about cost hold", "1 of 7 ... holds". Null in other suites. */
function writeDemandSentence() {
    const claims = results.demand ?? [];
    if (claims.length === 0) return null;
    const held = claims.filter((claim) => claim.held).length;
    return `${formatNumber(held, 0)} of ${countOf(claims.length, "claim")} about cost ` +
        `${held === 1 ? "holds" : "hold"}.`;
}

/** "The soak stayed within its bounds." Null in other suites. */
function writeSoakSentence() {
    const claims = results.soak ?? [];
    if (claims.length === 0) return null;
    return claims.every((claim) => claim.held)
        ? "Nothing grows over the frames of the soak." : "The soak left its bounds.";
}

/** The sections that show claims; each is a field of the results. */
const claimSections = ["demand", "soak"];

function nameQuantity({title, unit}) {
    return unit ? `${title} (${unit})` : title;
}

/** "y = 0.12 + 3.4 x, r² 0.998" */
function describeLine({slope, intercept, r2}) {
    const digits = (value) => Number(value.toPrecision(3)).toString();
    const sign = slope < 0 ? "−" : "+";
    return `y = ${digits(intercept)} ${sign} ${digits(Math.abs(slope))} x, ` +
        `r² ${formatNumber(r2, 3)}`;
}

function claimCanvasId(section, claim, curve) {
    return `${section}-${claim.name}-${curve.name}`;
}

/** Points with whiskers, and the line from the first to the last. */
function makeClaimSets(curve) {
    const color = cssColor("--accent");
    const points = curve.points.map((p) => ({
        x: p.x, y: p.median, label: p.label, quartiles: [p.q1, p.q3],
    }));
    const sets = [{
        label: curve.title, data: points, showLine: curve.line === null, borderWidth: 1.5,
        borderColor: color, backgroundColor: color, pointRadius: 5, pointHoverRadius: 7,
    }];
    if (curve.line) {
        const {slope, intercept} = curve.line;
        sets.push({
            label: `${curve.title}, line`,
            data: [points[0], points.at(-1)].map(({x}) => ({x, y: intercept + slope * x})),
            showLine: true, pointRadius: 0, pointHitRadius: 0, borderWidth: 1.5,
            borderDash: [3, 5], borderColor: cssColor("--ink-soft"),
        });
    }
    return sets;
}

function drawClaimCurve(section, claim, curve) {
    const canvas = byId(claimCanvasId(section, claim, curve));
    const values = curve.points.map((p) => p.x);
    const heights = curve.points.flatMap((p) => [p.q1, p.q3]);
    // A line is straight on linear axes alone; without one, decades may be far apart.
    const isWide = (list) => list.every((v) => v > 0) && Math.max(...list) > 50 * Math.min(...list);
    const logarithmicX = curve.line === null && isWide(values);
    const logarithmicY = curve.line === null && isWide(heights);
    canvas.setAttribute("aria-label", `${nameQuantity(curve.y)} against ${nameQuantity(curve.x)}`);
    drawChart(canvas, {
        data: {datasets: makeClaimSets(curve)},
        scales: {
            x: makeAxis(nameQuantity(curve.x), logarithmicX, values),
            y: makeAxis(nameQuantity(curve.y), logarithmicY, heights),
        },
        tooltip: {
            title: ([item]) => `${curve.title}, ${item.raw.label}`,
            label: (item) => withUnit(`${formatMs(item.raw.y)}`, curve.y.unit) +
                `, quartiles ${formatMs(item.raw.quartiles[0])} to ` +
                formatMs(item.raw.quartiles[1]),
        },
        whiskersAlong: "y",
    });
}

function makeClaimTable(claim) {
    const columns = ["Check", {content: "measured", class: "n"}, {content: "bound", class: "n"},
        "unit", {content: "used", class: "n"}, "verdict", "how"];
    if (claim.checks.length === 0)
        return makeTable(columns, [[claim.failure ?? "nothing was measured", "", "", "", "",
            makeVerdict(claim.held), ""]], {class: "stability"});
    return makeTable(columns, claim.checks.map((row) => [
        row.check,
        {content: formatError(row.worst), class: "n"},
        {content: formatError(row.bound), class: "n"},
        row.unit,
        {content: formatShare(row), class: "n soft"},
        makeVerdict(row.held),
        {content: row.note, class: "soft"}]), {class: "stability"});
}

function makeClaim(section, claim) {
    const plots = claim.curves.map((curve) => el("div", {},
        el("h4", {}, curve.title),
        el("div", {class: "plot"},
            el("canvas", {role: "img", id: claimCanvasId(section, claim, curve)})),
        curve.line ? el("p", {class: "small"}, describeLine(curve.line)) : null));
    return el("div", {id: `${section}-${claim.name}`},
        el("h3", {}, claim.title),
        el("p", {}, `${claim.description} Measured in ${formatNumber(claim.seconds, 1)} s.`),
        plots.length > 0 ? el("div", {class: "plots"}, ...plots) : null,
        makeClaimTable(claim));
}

function drawClaimCharts() {
    for (const section of claimSections)
        for (const claim of results[section] ?? [])
            for (const curve of claim.curves) drawClaimCurve(section, claim, curve);
}

function drawClaims() {
    for (const section of claimSections) {
        const claims = results[section] ?? [];
        if (claims.length === 0) continue;
        reveal(section);
        const broken = claims.filter((claim) => !claim.held);
        byId(`${section}-broken`).hidden = broken.length === 0;
        byId(`${section}-broken`).textContent =
            `Out of bounds: ${broken.map((claim) => claim.title).join("; ")}.`;
        byId(`${section}-claims`).replaceChildren(
            ...claims.map((claim) => makeClaim(section, claim)));
    }
    drawClaimCharts();
}
