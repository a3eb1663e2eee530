// Places the names of points so that they do not overlap each other and, if possible, do not hide points.

const LABEL_HEIGHT = 15;

function overlap(a, b) {
    return Math.max(0, Math.min(a.right, b.right) - Math.max(a.left, b.left)) *
        Math.max(0, Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top));
}

function boxAround(x, y, width, height) {
    return {left: x - width / 2, right: x + width / 2, top: y - height / 2, bottom: y + height / 2};
}

// Returns small boxes along a line of {x, y}.
function boxesAlong(corners) {
    return corners.slice(1).flatMap((end, i) => {
        const start = corners[i];
        const steps = Math.max(1, Math.ceil(Math.hypot(end.x - start.x, end.y - start.y) / 6));
        return Array.from({length: steps}, (_, step) => {
            const along = step / steps;
            return boxAround(start.x + (end.x - start.x) * along, start.y + (end.y - start.y) * along, 6, 6);
        });
    });
}

// Returns boxes for a label of this width around a point, the nearest first.
function candidates(anchor, width) {
    const boxes = [];
    for (const distance of [11, 20, 34, 52, 74, 100, 130]) {
        for (const [dx, dy] of [[1, 0], [0.7, -0.7], [0.7, 0.7], [0, -1], [0, 1], [-1, 0], [-0.7, -0.7], [-0.7, 0.7]]) {
            const x = anchor.x + dx * distance + Math.sign(dx) * width / 2;
            const y = anchor.y + dy * (distance + LABEL_HEIGHT / 2);
            boxes.push({...boxAround(x, y, width, LABEL_HEIGHT), distance});
        }
    }
    return boxes;
}

// Two neighbouring labels must not read as one, so each box is widened.
function widened(box) {
    return {...box, left: box.left - 6, right: box.right + 6};
}

// anchors: {x, y, width} of each label; obstacles: boxes that labels should not hide; within: the plot's box.
// Returns a box or null for each label. A name that fits nowhere is only in the list below the chart.
function placeLabels(anchors, obstacles, within) {
    const taken = [];
    return anchors.map((anchor) => {
        let best = null;
        let leastCost = Infinity;
        for (const box of candidates(anchor, anchor.width)) {
            const inside = box.left >= within.left && box.right <= within.right && box.top >= within.top && box.bottom <= within.bottom;
            if (!inside || taken.some((other) => overlap(widened(box), other) > 0)) {
                continue;
            }
            const hidden = obstacles.reduce((sum, other) => sum + overlap(box, other), 0);
            const cost = box.distance + hidden * 3;
            if (cost < leastCost) {
                leastCost = cost;
                best = box;
            }
        }
        if (best) {
            taken.push(best);
        }
        return best;
    });
}

// Returns a line from a point to a label that is not beside it.
function leader(anchor, box) {
    const x = Math.min(Math.max(anchor.x, box.left), box.right);
    const y = Math.min(Math.max(anchor.y, box.top), box.bottom);
    return Math.hypot(x - anchor.x, y - anchor.y) > 18 ? svg("path", {class: "leader", d: `M${anchor.x},${anchor.y}L${x},${y}`}) : null;
}
