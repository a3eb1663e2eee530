// Finds the lights of the hierarchy along a ray. Its nodes are in depth-first order: the first child of a node follows
// it, and the second one waits until all nodes below the first are done.
#include "hit/bindings.glsl"

// The rounding error of the coordinates of boxes, as a share of them.
const float kBoxRounding = 1.2e-7;
// The least component of a direction, which keeps quotients finite.
const float kLeastComponent = 1e-18;

struct LightSearch {
    vec3 origin;
    vec3 inverse;   // of the direction, by component
    float end;      // the distance beyond which nothing counts
    uint apart;     // leaves apart from the tree that are left
    uint waiting;   // nodes that wait
    uint places[kLightTreeDepth];
};

// The lights apart have no bounds. A tree of emissive triangles alone has no light for which the search looks.
LightSearch searchLeaves(vec3 origin, vec3 direction, float end, bool looks) {
    LightSearch search;
    search.origin = origin;
    vec3 size = max(abs(direction), kLeastComponent);
    search.inverse = vec3(direction.x < 0.0 ? -1.0 : 1.0, direction.y < 0.0 ? -1.0 : 1.0,
                          direction.z < 0.0 ? -1.0 : 1.0) / size;
    search.end = end;
    search.apart = looks ? GLINT_FRAME.lightsApart : 0u;
    search.waiting = looks && GLINT_FRAME.lightsApart < GLINT_FRAME.lightCount ? 1u : 0u;
    search.places[0] = 0u;
    return search;
}

// Returns whether the ray meets the box of a node that shines on its origin.
bool meetsNode(LightSearch search, LightNode node) {
    vec3 rounding = kBoxRounding * max(abs(node.lower), abs(node.upper));
    vec3 lower = node.lower - rounding - search.origin;
    vec3 upper = node.upper + rounding - search.origin;
    vec3 outside = max(max(lower, -upper), vec3(0.0));
    vec3 first = min(lower * search.inverse, upper * search.inverse);
    vec3 last = max(lower * search.inverse, upper * search.inverse);
    float enters = max(max(first.x, first.y), max(first.z, 0.0));
    float leaves = min(min(last.x, last.y), min(last.z, search.end));
    return enters <= leaves && node.intensity > 0.0 && dot(outside, outside) <= node.reach * node.reach;
}

// Returns whether there is a further leaf of a punctual light that the ray may meet, and its index.
bool findsLeaf(inout LightSearch search, out uint leaf) {
    if (search.apart > 0u) {
        search.apart -= 1u;
        leaf = GLINT_FRAME.lightTreeNodes + search.apart;
        return true;
    }
    while (search.waiting > 0u) {
        search.waiting -= 1u;
        leaf = search.places[search.waiting];
        for (;;) {
            LightNode node = GLINT_FRAME.lightNodes.data[leaf];
            if (!meetsNode(search, node)) {
                break;
            }
            if ((node.next & kLightLeaf) != 0u) {
                if ((node.next & kLightEmitter) == 0u) {
                    return true;
                }
                break;
            }
            search.places[search.waiting] = node.next;
            search.waiting += 1u;
            leaf += 1u;
        }
    }
    leaf = 0u;
    return false;
}
