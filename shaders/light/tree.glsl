// Chooses one of many lights by the hierarchy over them: Conty Estevez and Kulla, "Importance Sampling of Many Lights
// with Adaptive Tree Splitting" (2018), and pbrt-v4's BVHLightSampler. From the root on, the samples of a surface are
// divided between the children of each node in proportion to their importance. Every expression that decides is
// `precise`, because all strategies choose the same light.
#include "hit/bindings.glsl"
#include "light/punctual.glsl"

// The least factor for the angle under which a node is seen. It keeps lights at the edge of their cone reachable.
const float kMinLightFacing = 0.05;
// The least squared distance to a point that stands for lights, as a share of their variance.
const float kLightSpread = 0.25;
// The rounding error that the cosines of bounds may have.
const float kLightCosineSlack = 1e-3;
// The distance between random numbers.
const float kGrain = 1.0 / 16777216.0;
// If the distance between random numbers has grown to this share of the rest of the line, another random number is
// taken.
const float kCoarseGrain = 1.0 / 4096.0;

// max(a - b, 0) of angles as cosine and sine, from those of a and b in [0, pi].
vec2 angleBeyond(vec2 a, vec2 b) {
    precise vec2 difference = vec2(a.x * b.x + a.y * b.y, a.y * b.x - a.x * b.y);
    return a.x >= b.x ? vec2(1.0, 0.0) : difference;
}

vec2 withSine(float cosine) {
    precise float square = max(1.0 - cosine * cosine, 0.0);
    return vec2(cosine, sqrt(square));
}

// The surface that chooses.
struct LightReceiver {
    vec3 position;
    vec3 normal;  // unit vector, on the side from which light is scattered; 0 if light from both sides is
};

// A normal in 32 bits, by octahedralEncode(). The choice and the computation of its probability use the same normal, in
// every shader.
const uint kBothSides = 0x80008000u;  // no vector has these

uint packReceiver(vec3 normal) {
    precise float sum = abs(normal.x) + abs(normal.y) + abs(normal.z);
    precise vec2 p = normal.xy / sum;
    precise vec2 folded = (1.0 - abs(p.yx)) * vec2(p.x >= 0.0 ? 1.0 : -1.0, p.y >= 0.0 ? 1.0 : -1.0);
    return packSnorm2x16(normal.z >= 0.0 ? p : folded);
}

vec3 unpackReceiver(uint packedNormal) {
    vec2 e = unpackSnorm2x16(packedNormal);
    precise float z = 1.0 - abs(e.x) - abs(e.y);
    precise float fold = max(-z, 0.0);
    vec3 normal = directionOr(vec3(e.x + (e.x >= 0.0 ? -fold : fold), e.y + (e.y >= 0.0 ? -fold : fold), z), vec3(0.0));
    return packedNormal == kBothSides ? vec3(0.0) : normal;
}

vec3 sharesOf(uint packedShares) {
    uvec3 shares = uvec3(packedShares, packedShares >> 10, packedShares >> 20) & kLightShares;
    precise vec3 result = vec3(shares) * (1.0 / float(kLightShares));
    return result;
}

// The mean of cos θ / d² over the lights of a node, from four points: a standard deviation from their mean along the
// two axes on which they vary most. A single point would give far too little light to a surface close to some of them.
// `away` is from that mean to the surface.
float meanOfNode(vec3 away, vec3 deviation, vec3 normal) {
    bool flatX = deviation.x <= deviation.y && deviation.x <= deviation.z;
    bool flatY = !flatX && deviation.y <= deviation.z;
    vec3 first = flatX ? vec3(0.0, deviation.y, 0.0) : vec3(deviation.x, 0.0, 0.0);
    vec3 second = flatX || flatY ? vec3(0.0, 0.0, deviation.z) : vec3(0.0, deviation.y, 0.0);
    const vec4 kFirst = vec4(1.0, 1.0, -1.0, -1.0);
    const vec4 kSecond = vec4(1.0, -1.0, 1.0, -1.0);
    precise vec4 squares = (dot(away, away) + dot(first, first) + dot(second, second)) -
                           2.0 * (dot(away, first) * kFirst + dot(away, second) * kSecond);
    // The lights that a point stands for lie around it.
    precise float least = kLightSpread * dot(deviation, deviation);
    squares = max(squares, max(least, kMinSquaredDistance));
    precise vec4 inverse = inversesqrt(squares);
    precise vec4 cosines = vec4(1.0);
    if (normal != vec3(0.0)) {
        precise vec4 heights = dot(normal, first) * kFirst + dot(normal, second) * kSecond - dot(normal, away);
        cosines = max(heights * inverse, kMinLightFacing);
    }
    precise vec4 terms = cosines * (inverse * inverse);
    precise float mean = 0.25 * (terms.x + terms.y + terms.z + terms.w);
    return mean;
}

// Returns whether all of a node's box is below a surface. `away` is from the middle of the box to the surface, and
// `radius` is half of the box.
bool isBelow(vec3 normal, vec3 away, vec3 radius, float squared) {
    precise float highest = dot(abs(normal), radius) - dot(normal, away);
    // (|away| + |radius|)² is no more than twice the sum of the squares.
    precise float slack2 = 2.0 * kLightCosineSlack * kLightCosineSlack * (squared + dot(radius, radius));
    return highest < 0.0 && highest * highest > slack2;
}

// An estimate of the irradiance that the lights of a node bring to a surface, without shadows. It is 0 only if they
// bring none.
float lightImportance(LightNode node, LightReceiver receiver) {
    vec3 position = receiver.position;
    precise vec3 outside = max(max(node.lower - position, position - node.upper), vec3(0.0));
    precise float gap = dot(outside, outside);
    if (gap > node.reach * node.reach) {
        return 0.0;
    }
    precise vec3 size = node.upper - node.lower;
    precise vec3 radius = 0.5 * size;
    precise vec3 away = position - 0.5 * (node.lower + node.upper);
    precise float squared = dot(away, away);
    if (isBelow(receiver.normal, away, radius, squared)) {
        return 0.0;
    }
    precise float radius2 = dot(radius, radius);
    float facing = 1.0;
    // If the point is among the lights, they shine in all directions.
    if (node.cosAxes > -1.0 && squared > radius2) {
        // The least angle between the axis of some light and its direction to the point.
        precise float cosine = clamp(dot(node.axis, away) / sqrt(squared), -1.0, 1.0);
#if GLINT_EMISSIVE_LIGHTS
        cosine = node.reach < 0.0 ? abs(cosine) : cosine;
#endif
        precise float sine2 = radius2 / squared;
        vec2 box = vec2(sqrt(1.0 - sine2), sqrt(sine2));
        vec2 least = angleBeyond(angleBeyond(withSine(cosine), withSine(node.cosAxes)), box);
        if (least.x < node.cosEmission - kLightCosineSlack) {
            return 0.0;
        }
        facing = max(least.x, kMinLightFacing);
    }
    precise vec3 mean = node.lower + size * sharesOf(node.mean3x10);
    precise vec3 deviation = radius * sharesOf(node.deviation3x10);
    precise float importance =
        node.intensity * facing * meanOfNode(position - mean, deviation, receiver.normal);
    return importance;
}

// The samples of a surface lie side by side on a line as long as their number, and so do the lights of a tree, each
// with a part as long as the number of samples that it expects. A sample is of the light in whose part it lies.
struct LightSubtree {
    uint root;
    uint end;       // the node after the last one
    float samples;  // the length of its part
};

// Returns how many lights are below a node of so many nodes, which include the node itself.
float lightsOfNodes(uint nodes) {
    return float((nodes + 1u) / 2u);
}

LightSubtree wholeLightTree() {
    LightSubtree tree = LightSubtree(0u, GLINT_FRAME.lightTreeNodes, float(GLINT_LIGHT_SAMPLES));
#if !GLINT_EMISSIVE_LIGHTS
    tree.samples = min(tree.samples, lightsOfNodes(tree.end));
#endif
    return tree;
}

// The samples of the first child, in proportion to the importance of both. A punctual light has at most one, because a
// second one would see the same. The remaining samples go to other lights. So lights that are bright enough for a
// sample of their own bring no noise. Samples of emissive triangles see different points of them.
float samplesOfFirst(LightSubtree tree, uint second, float share) {
    precise float samples = tree.samples * share;
#if !GLINT_EMISSIVE_LIGHTS
    precise float least = tree.samples - lightsOfNodes(tree.end - second);
    samples = min(max(samples, least), lightsOfNodes(second - tree.root - 1u));
#endif
    return samples;
}

// Returns the number of the light at a place on the line, and how many samples of a surface it expects, which is 0 if no
// light there brings light to the surface. `more` is uniform in [0, 1)².
uint lightOfTree(LightReceiver receiver, float place, vec2 more, out float chance) {
    LightNodeArray nodes = GLINT_FRAME.lightNodes;
    LightSubtree tree = wholeLightTree();
    precise float along = place;
    precise float grain = kGrain * float(GLINT_LIGHT_SAMPLES);
    uint numbers = 1u;
    chance = 0.0;
    if (along >= tree.samples) {
        return 0u;
    }
    uint next = nodes.data[0].next;
    while ((next & kLightLeaf) == 0u) {
        float first = lightImportance(nodes.data[tree.root + 1u], receiver);
        float second = lightImportance(nodes.data[next], receiver);
        precise float both = first + second;
        if (!(both > 0.0)) {
            return 0u;
        }
        precise float share = first / both;
        precise float samples = samplesOfFirst(tree, next, share);
        // A number stands for those up to the next one, so their middle decides. Otherwise the number 0 would choose
        // lights whose part of the line is far shorter than the distance of the numbers, and these would be far too
        // bright.
        precise float middle = along + 0.5 * grain;
        bool isFirst = middle < samples || samples >= tree.samples;
        if ((isFirst ? first : second) <= 0.0) {
            return 0u;
        }
        if (isFirst) {
            tree = LightSubtree(tree.root + 1u, next, samples);
        } else {
            along = max(along - samples, 0.0);
            precise float rest = tree.samples - samples;
            tree = LightSubtree(next, tree.end, rest);
        }
        if (grain > kCoarseGrain * tree.samples && numbers < 3u) {
            along = tree.samples * (numbers == 1u ? more.x : more.y);
            grain = kGrain * tree.samples;
            numbers += 1u;
        }
        next = nodes.data[tree.root].next;
    }
    chance = tree.samples;
    return next & ~kLightLeaf;
}

// Returns how many samples of a surface lightOfTree() is expected to give to the light of a leaf. The first child of a
// node has all nodes up to the second one below it, so the way to a leaf follows from its index.
float lightChance(LightReceiver receiver, uint leaf) {
    LightNodeArray nodes = GLINT_FRAME.lightNodes;
    LightSubtree tree = wholeLightTree();
    uint next = nodes.data[0].next;
    while (tree.root != leaf) {
        float first = lightImportance(nodes.data[tree.root + 1u], receiver);
        float second = lightImportance(nodes.data[next], receiver);
        bool isFirst = leaf < next;
        if (!((isFirst ? first : second) > 0.0)) {
            return 0.0;
        }
        precise float both = first + second;
        precise float share = first / both;
        precise float samples = samplesOfFirst(tree, next, share);
        if (isFirst) {
            tree = LightSubtree(tree.root + 1u, next, samples);
        } else {
            precise float rest = tree.samples - samples;
            tree = LightSubtree(next, tree.end, rest);
        }
        next = nodes.data[tree.root].next;
    }
    return tree.samples;
}
