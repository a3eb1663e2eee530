// Chooses one of many lights by the hierarchy over them: Conty Estevez and Kulla, "Importance Sampling of Many Lights
// with Adaptive Tree Splitting" (2018), and pbrt-v4's BVHLightSampler. From the root on, a child is chosen in
// proportion to its importance, so the probability of a light is the product over its way. Every expression that
// decides is `precise`, because all strategies choose the same light.
#include "hit/bindings.glsl"
#include "hit/punctual.glsl"

// The least factor for the angle under which a node is seen. It keeps lights at the edge of their cone reachable.
const float kMinLightFacing = 0.05;
// What the cosines of bounds may lose to rounding.
const float kLightCosineSlack = 1e-3;
// The levels after which another random number is taken. A choice costs one bit of 24 on average.
const uint kLevelsOfNumber = 12u;
// The most that a random number is: the largest float below 1.
const float kBelowOne = 0.99999994;

// max(a - b, 0) of angles as cosine and sine, from those of a and b in [0, pi].
vec2 angleBeyond(vec2 a, vec2 b) {
    precise vec2 difference = vec2(a.x * b.x + a.y * b.y, a.y * b.x - a.x * b.y);
    return a.x >= b.x ? vec2(1.0, 0.0) : difference;
}

vec2 withSine(float cosine) {
    precise float square = max(1.0 - cosine * cosine, 0.0);
    return vec2(cosine, sqrt(square));
}

// An estimate of the irradiance that the lights of a node bring to a surface which faces them, without shadows. It is 0
// only if they bring none.
float lightImportance(LightNode node, vec3 position) {
    precise vec3 outside = max(max(node.lower - position, position - node.upper), vec3(0.0));
    precise float gap = dot(outside, outside);
    if (gap > node.reach * node.reach) {
        return 0.0;
    }
    precise vec3 radius = 0.5 * (node.upper - node.lower);
    precise vec3 away = position - 0.5 * (node.lower + node.upper);
    precise float radius2 = dot(radius, radius);
    precise float squared = dot(away, away);
    float facing = 1.0;
    if (squared > radius2) {
        // The least angle between the axis of some light and its direction to the point.
        precise float cosine = clamp(dot(node.axis, away) / sqrt(squared), -1.0, 1.0);
        precise float sine2 = radius2 / squared;
        vec2 box = vec2(sqrt(1.0 - sine2), sqrt(sine2));
        vec2 least = angleBeyond(angleBeyond(withSine(cosine), withSine(node.cosAxes)), box);
        if (least.x < node.cosEmission - kLightCosineSlack) {
            return 0.0;
        }
        facing = max(least.x, kMinLightFacing);
    }
    // Within its box a light may be anywhere.
    precise float importance = node.intensity * facing / max(max(squared, radius2), kMinSquaredDistance);
    return importance;
}

// Returns the number of a light of the tree and the probability with which it was chosen, which is 0 if none brings
// light to the point. `u` is uniform in [0, 1)³.
uint lightOfTree(vec3 position, vec3 u, out float probability) {
    LightNodeArray nodes = GLINT_FRAME.lightNodes;
    uint index = 0u;
    precise float product = 1.0;
    precise float random = u.x;
    uint level = 0u;
    uint next = nodes.data[0].next;
    while ((next & kLightLeaf) == 0u) {
        float first = lightImportance(nodes.data[index + 1u], position);
        float second = lightImportance(nodes.data[next], position);
        precise float both = first + second;
        if (!(both > 0.0)) {
            probability = 0.0;
            return 0u;
        }
        precise float share = first / both;
        if (random < share) {
            index += 1u;
            random = random / share;
            product *= share;
        } else {
            index = next;
            random = (random - share) / (1.0 - share);
            product *= 1.0 - share;
        }
        level += 1u;
        random = level == kLevelsOfNumber ? u.y : level == 2u * kLevelsOfNumber ? u.z : min(random, kBelowOne);
        next = nodes.data[index].next;
    }
    probability = product;
    return next & ~kLightLeaf;
}

// The probability with which lightOfTree() chooses the light of a leaf. The first child of a node has all nodes up to
// the second one below it, so the way to a leaf follows from its index.
float lightProbability(vec3 position, uint leaf) {
    LightNodeArray nodes = GLINT_FRAME.lightNodes;
    uint index = 0u;
    precise float product = 1.0;
    uint next = nodes.data[0].next;
    while (index != leaf) {
        float first = lightImportance(nodes.data[index + 1u], position);
        float second = lightImportance(nodes.data[next], position);
        precise float both = first + second;
        if (!(both > 0.0)) {
            return 0.0;
        }
        precise float share = first / both;
        product *= leaf < next ? share : 1.0 - share;
        index = leaf < next ? index + 1u : next;
        next = nodes.data[index].next;
    }
    return product;
}
