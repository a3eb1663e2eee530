// Draws the page, and keeps it up to date.

function main() {
    showHeading();
    showFilters();
    showChartLegend();
    onChange(["metric", "filter", "kind"], drawChart);
    onChange(["selected", "pointed"], markPoints);
    onChange(["selected", "pointed", "metric"], showDetail);
    onChange(["metric"], showSettingsTable);
    onChange(["metric", "filter", "kind"], showPointsTable);
    onChange(["metric"], showErrorParts);
    onChange(["metric"], drawLadder);
    onChange(["metric"], drawLadderPictures);
    drawChart();
    showDetail();
    showPointsTable();
    showPasses();
    showSettingsTable();
    showErrorParts();
    showLadders();
    showImages();
    showStrategies();
    showMethod();
    redrawOnResize();
}

// Charts are drawn for the width that is available, so they are drawn again when it changes.
function redrawOnResize() {
    let width = byId("chart-box").clientWidth;
    new ResizeObserver(() => {
        if (byId("chart-box").clientWidth !== width) {
            width = byId("chart-box").clientWidth;
            drawChart();
            drawLadder();
            if (!byId("passes").hidden) {
                drawPasses();
            }
        }
    }).observe(byId("chart-box"));
}
