// Shows pictures: two of them under a slider, and many side by side.

const REFERENCE = "reference";
// The values of the two selects: "selected", "reference", or the id of a point.
const sides = {left: "selected", right: REFERENCE};
let layer = "image";
let revealed = 50;  // per cent of the width that show the left picture

function hasImage(point) {
    return imageUri(point?.image) !== null;
}

function showImages() {
    if (!points.some(hasImage)) {
        hideSection("images");
        return;
    }
    const pictured = points.filter(hasImage).map((point) => [String(point.id), point.name]);
    const reference = imageUri(report.reference?.image) ? [[REFERENCE, "the reference"]] : [];
    sides.right = reference.length > 0 ? REFERENCE : String(defaultPoint.id);
    for (const side of ["left", "right"]) {
        fillSelect(byId(side), [["selected", "the selected point"], ...reference, ...pictured], sides[side], (value) => {
            sides[side] = value;
            showSlider();
        });
    }
    byId("layer").addEventListener("change", () => { layer = byId("layer").value; showSlider(); });
    fillSelect(byId("grid-of"), [["front", "the Pareto front and the default"], ["shown", "all that the chart shows"]], "front", showGrid);
    onChange(["selected"], showSlider);
    onChange(["metric", "filter", "kind"], showGrid);
    showSlider();
    showGrid();
}

// Returns {name, uri} of one side. The reference has no error map, so it shows its picture instead.
function sideOf(choice) {
    if (choice === REFERENCE) {
        return {name: "reference", uri: imageUri(report.reference?.image)};
    }
    const point = choice === "selected" ? selectedPoint() : pointById.get(Number(choice));
    const map = layer === "errorImage" ? imageUri(point?.errorImage) : null;
    return {name: (point?.name ?? "no point") + (map ? ", error" : ""), uri: map ?? imageUri(point?.image)};
}

function picture(uri, name, attributes = {}) {
    const {width = 16, height = 9} = report.scene ?? {};
    // Pixels of a small picture must be visible one by one. A large picture is shrunk and smoothed.
    const looks = [attributes.class, width <= 320 ? "pixels" : null].filter((name) => name).join(" ");
    return uri ? html("img", {src: uri, alt: name, width, height, ...attributes, class: looks || null})
        : html("span", {class: "no-image", ...attributes}, `no picture of ${name}`);
}

function showSlider() {
    const left = sideOf(sides.left);
    const right = sideOf(sides.right);
    const over = picture(left.uri, left.name, {class: "over", id: "slider-left"});
    const reveal = (value) => {
        revealed = value;
        over.style.clipPath = `inset(0 ${100 - value}% 0 0)`;
        line.style.left = `${value}%`;
    };
    const line = html("span", {class: "line"});
    const handle = html("input", {type: "range", id: "reveal", min: 0, max: 100, step: 1, value: revealed,
                                  "aria-label": `How much of ${left.name} covers ${right.name}, per cent`,
                                  oninput: (event) => reveal(Number(event.target.value))});
    byId("slider").replaceChildren(
        html("div", {class: "captions"}, html("span", {}, `◀ ${left.name}`), html("span", {}, `${right.name} ▶`)),
        html("div", {class: "stage"}, picture(right.uri, right.name, {id: "slider-right"}), over, line, handle));
    reveal(revealed);
}

function showGrid() {
    const metric = metricOf(state.metric);
    const front = frontFor(metric);
    const all = byId("grid-of").value === "shown";
    const ids = all ? points.filter(isShown).map((point) => point.id) : [...new Set([defaultPoint.id, ...front])];
    const reference = imageUri(report.reference?.image);
    byId("grid").replaceChildren(
        ...(reference ? [html("figure", {}, html("div", {class: "pair"}, picture(reference, "reference")), html("figcaption", {}, html("strong", {}, "Reference")))] : []),
        ...ids.map((id) => pointById.get(id)).filter(hasImage).map((point) => html("figure", {"data-id": point.id},
            html("div", {class: "pair"}, picture(imageUri(point.image), point.name),
                 imageUri(point.errorImage) ? picture(imageUri(point.errorImage), `error of ${point.name}`) : null),
            html("figcaption", {}, html("button", {type: "button", class: "link", onclick: () => change({selected: point.id})}, point.name),
                 ` ${milliseconds(point.time?.median)}, ${signedName(metric)} ${errorText(point, metric)}`))));
}
