// Chooses one of many lights by the hierarchy over them: Conty Estevez and Kulla, "Importance Sampling of Many Lights
// with Adaptive Tree Splitting" (2018), and pbrt-v4's BVHLightSampler. From the root on, a child is chosen in
// proportion to its importance, so the probability of a light is the product over its way. Every expression that
// decides is `precise`, because all strategies choose the same light.
#include "hit/bindings.glsl"
#include "light/punctual.glsl"

// The least factor for the angle under which a node is seen. It keeps lights at the edge of their cone reachable.
const float kMinLightFacing = 0.05;
// The least squared distance to a point that stands for lights, as a share of their variance.
const float kLightSpread = 0.25;
// What the cosines of bounds may lose to rounding.
const float kLightCosineSlack = 1e-3;
// The distance between random numbers. Each choice divides it by the probability of what was chosen.
const float kGrain = 1.0 / 16777216.0;
// Where the distance has grown to this, another random number is taken.
const float kCoarseGrain = 1.0 / 4096.0;
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

// The surface that chooses.
struct LightReceiver {
    vec3 position;
    vec3 normal;  // unit vector, on the side from which light is scattered; 0 if light from both sides is
};

// A normal in 32 bits, by octahedralEncode(). Whoever chooses and whoever asks for the probability use the same one, in
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

// The mean of cos θ / d² over the lights of a node, from four points: a standard deviation from their mean along the two
// axes on which they vary most. One point would bring far too little where the surface is close to some of them. `away`
// is from that mean to the surface.
float meanOfNode(vec3 away, vec3 deviation, vec3 normal) {
    bool flatX = deviation.x <= deviation.y && deviation.x <= deviation.z;
    bool flatY = !flatX && deviation.y <= deviation.z;
    vec3 first = flatX ? vec3(0.0, deviation.y, 0.0) : vec3(deviation.x, 0.0, 0.0);
    vec3 second = flatX || flatY ? vec3(0.0, 0.0, deviation.z) : vec3(0.0, deviation.y, 0.0);
    const vec4 kFirst = vec4(1.0, 1.0, -1.0, -1.0);
    const vec4 kSecond = vec4(1.0, -1.0, 1.0, -1.0);
    precise vec4 squares = (dot(away, away) + dot(first, first) + dot(second, second)) -
                           2.0 * (dot(away, first) * kFirst + dot(away, second) * kSecond);
    // Around each point are the lights that it stands for.
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

// Whether all of a node's box is below a surface. `away` is from the middle of the box to the surface, and `radius` is
// half of the box.
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
    // With points among them the lights shine everywhere.
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

// Returns the number of a light of the tree and the probability with which it was chosen, which is 0 if none brings
// light to the surface. `u` is uniform in [0, 1)³.
uint lightOfTree(LightReceiver receiver, vec3 u, out float probability) {
    LightNodeArray nodes = GLINT_FRAME.lightNodes;
    uint index = 0u;
    precise float product = 1.0;
    precise float random = u.x;
    precise float grain = kGrain;
    uint numbers = 1u;
    uint next = nodes.data[0].next;
    while ((next & kLightLeaf) == 0u) {
        float first = lightImportance(nodes.data[index + 1u], receiver);
        float second = lightImportance(nodes.data[next], receiver);
        precise float both = first + second;
        if (!(both > 0.0)) {
            probability = 0.0;
            return 0u;
        }
        precise float share = first / both;
        // A number stands for those up to the next one, so their middle decides. Otherwise the number 0 would choose
        // lights whose probability is far below that of the number, and these would be far too bright.
        precise float middle = random + 0.5 * grain;
        precise float taken = share;
        if (share >= 1.0 || middle < share) {
            index += 1u;
            random = random / share;
        } else {
            taken = 1.0 - share;
            index = next;
            random = max(random - share, 0.0) / taken;
        }
        product *= taken;
        grain = grain / taken;
        if (grain > kCoarseGrain && numbers < 3u) {
            random = numbers == 1u ? u.y : u.z;
            grain = kGrain;
            numbers += 1u;
        }
        random = min(random, kBelowOne);
        next = nodes.data[index].next;
    }
    probability = product;
    return next & ~kLightLeaf;
}

// The probability with which lightOfTree() chooses the light of a leaf. The first child of a node has all nodes up to
// the second one below it, so the way to a leaf follows from its index.
float lightProbability(LightReceiver receiver, uint leaf) {
    LightNodeArray nodes = GLINT_FRAME.lightNodes;
    uint index = 0u;
    precise float product = 1.0;
    uint next = nodes.data[0].next;
    while (index != leaf) {
        float first = lightImportance(nodes.data[index + 1u], receiver);
        float second = lightImportance(nodes.data[next], receiver);
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
