// SPDX-License-Identifier: MIT
// Hard cases: the worst that each check met beside what it may meet.

/** "0", "0.0312", "3.2e-7": errors span many decades. */
function formatError(value) {
    if (value === null) return "not finite";
    if (value === 0) return "0";
    const plain = value >= 0.001 && value < 1e6;
    return plain ? Number(value.toPrecision(3)).toLocaleString("en") : value.toExponential(1);
}

/** How much of the bound is used; nothing where the bound is 0. */
function formatShare({worst, bound}) {
    return worst !== null && bound > 0 ? `${formatNumber((100 * worst) / bound, 0)} %` : "";
}

function makeVerdict(held) {
    return {content: held ? "holds" : "broken", class: held ? "better" : "worse"};
}

/** One row a check; what is said of the case stands in its first. */
function makeStabilityRows(hard) {
    const ofCase = (text, extra = {}) => ({content: text, ...extra});
    const nameCell = ofCase(hard.title, {title: hard.description});
    const seconds = ofCase(formatNumber(hard.seconds, 2), {class: "n soft"});
    if (hard.checks.length === 0) {
        return [[nameCell, hard.failure ?? "nothing was measured", "", "", "", "", "", "",
            makeVerdict(hard.held), seconds]];
    }
    return hard.checks.map((row, i) => [
        i === 0 ? nameCell : ofCase("", {class: "absent"}),
        row.note ? ofCase(row.check, {title: `worst: ${row.note}`}) : row.check,
        {content: formatError(row.worst), class: "n"},
        {content: formatError(row.bound), class: "n"},
        row.unit,
        {content: formatShare(row), class: "n soft"},
        {content: formatNumber(row.notFinite, 0), class: row.notFinite > 0 ? "n worse" : "n"},
        {content: formatNumber(row.samples, 0), class: "n soft"},
        makeVerdict(row.held),
        i === 0 ? seconds : ""]);
}

/** "42 of 42 hard cases keep within their bounds." Null in other suites. */
function writeStabilitySentence() {
    const cases = results.stability ?? [];
    if (cases.length === 0) return null;
    const held = cases.filter((hard) => hard.held).length;
    const keep = cases.length === 1 ? "keeps within its bounds" : "keep within their bounds";
    return `${formatNumber(held, 0)} of ${countOf(cases.length, "hard case")} ${keep}.`;
}

function drawStability() {
    const cases = results.stability ?? [];
    if (cases.length === 0) return;
    reveal("stability");
    const sum = (of) => cases.flatMap((hard) => hard.checks).reduce((s, row) => s + of(row), 0);
    byId("stability-note").textContent =
        `${formatNumber(sum((row) => row.samples), 0)} values, pixels and rays in ` +
        `${countOf(sum(() => 1), "check")}, ${formatNumber(sum((row) => row.notFinite), 0)} of ` +
        "them NaN or infinite. A half ulp is a unit in the last place of the half floats that " +
        "pictures are stored in; 2^-24 is one rounding to single precision.";
    const broken = cases.filter((hard) => !hard.held);
    byId("stability-broken").hidden = broken.length === 0;
    byId("stability-broken").textContent =
        `Out of bounds: ${broken.map((hard) => hard.title).join("; ")}.`;
    const columns = ["Case", "Check", {content: "worst", class: "n"},
        {content: "bound", class: "n"}, "unit", {content: "used", class: "n"},
        {content: "NaN, ∞", class: "n"}, {content: "samples", class: "n"}, "verdict",
        {content: "seconds", class: "n"}];
    byId("stability-table").replaceChildren(
        makeTable(columns, cases.flatMap(makeStabilityRows), {class: "stability"}));
}
