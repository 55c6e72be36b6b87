// SPDX-License-Identifier: MIT
// Puts the page together and listens to its toolbar.

function fillToolbar() {
    fillSelect(byId("case"), results.cases.map((c) => ({value: c.name, label: c.title})),
        chosen.case?.name);
    fillSelect(byId("metric"), results.metrics.map((m) => ({value: m.id, label: m.name})),
        chosen.metric?.id);
    byId("case-choice").hidden = results.cases.length < 2;
    byId("metric-choice").hidden = results.cases.length === 0;
    byId("toolbar").hidden = results.cases.length === 0 && (results.scaling ?? []).length === 0;
    byId("toolbar").addEventListener("submit", (event) => event.preventDefault());
    byId("case").addEventListener("change", (event) =>
        choose({case: results.cases.find((c) => c.name === event.target.value)}));
    byId("metric").addEventListener("change", (event) =>
        choose({metric: metricById.get(event.target.value)}));
    byId("time").addEventListener("change", (event) => choose({time: event.target.value}));
}

function fillContents() {
    const sections = [...document.querySelectorAll("main > section:not([hidden])")];
    byId("contents").replaceChildren(...sections.map((section) =>
        el("a", {href: `#${section.id}`}, section.querySelector("h2").textContent)));
}

function saveResults() {
    const url = URL.createObjectURL(
        new Blob([JSON.stringify(results, null, 2)], {type: "application/json"}));
    el("a", {href: url, download: "results.json"}).click();
    URL.revokeObjectURL(url);
}

function drawChosen() {
    byId("case").value = chosen.case?.name ?? "";
    drawDial();
    drawLadder();
    drawTradeoff();
    drawMatrix();
    drawPictures();
    drawSlider();
    drawEqualTime();
    drawScaling();
    fillContents();
}

fillToolbar();
drawHeadline();
drawTables();
drawAbout();
startSequences();
startPlayer();
drawChosen();
onChoice(drawChosen);
onTheme(() => {
    drawDial();
    drawTradeoff();
    drawScaling();
    drawSequenceCurves();
});
byId("save").addEventListener("click", saveResults);
document.documentElement.dataset.ready = "true";
