// A hit with its vertex attributes fetched and interpolated: everything that materials read apart from their own
// record.
#include "host/geometry.glsl"
#include "bsdf/features.glsl"
#include "generated/attributes.glsl"
#include "hit/geometry.glsl"
#include "hit/lod.glsl"
#include "hit/triangle.glsl"
#if GLINT_PATHS
#include "hit/path.glsl"
#endif

struct Hit {
    vec3 position;         // world
    vec3 geometricNormal;  // unit vector, on the viewer's side
    float clearance;       // metres along geometricNormal at which a ray that leaves the surface must start
    vec3 normal;           // interpolated, unit vector, on the side that the surface's front faces
    vec3 view;             // unit vector, towards the viewer
    bool frontFace;
    uint material;
    uint target;  // number of the hit's sample; for a primary surface, of its pixel
    vec2 texCoords[2];
    vec4 color;
    vec4 tangent;    // world; w is the sign of the bitangent
    vec3 edges[2];   // world: from the first vertex to the second and third
    vec4 uvEdges[2]; // for each UV set: (Δu, Δv) along each edge
    vec4 footprint;  // axes of the ray cone's ellipse, across the ray and along it, in units of the edges
    float scale;     // metres of the world for one unit of the mesh
#if GLINT_ANSWERS_SURFACE
    uint shaderId;
    vec3 previousPosition;  // of the same point of the mesh, in the frame before
#endif
#if GLINT_VERTEX_ATTRIBUTES
    VertexAttributes attributes;  // of packs
#endif
#if GLINT_PATHS
    PathArrival arrival;  // of the hit of a ray
    vec3 inset;           // from `position` to where rays start, within the triangle's plane: see edgeInset()
#endif
#if GLINT_EMISSIVE_LIGHTS
    uint geometry;  // of the hit of a ray, as the next two
    uint primitive;
    vec3 start;     // of the ray
#endif
};

// Returns the start of a ray from the surface. It lies off the surface, on the side to which `direction` points.
vec3 rayOrigin(Hit hit, vec3 direction) {
    float side = dot(hit.geometricNormal, direction) < 0.0 ? -1.0 : 1.0;
#if GLINT_PATHS
    precise vec3 origin = hit.position + hit.inset + side * hit.clearance * hit.geometricNormal;
#else
    precise vec3 origin = hit.position + side * hit.clearance * hit.geometricNormal;
#endif
    return origin;
}

// Returns a point of a triangle in the world.
vec3 trianglePosition(HostGeometry geometry, uint primitive, vec2 barycentrics) {
    vec3 p[3];
    hostPositions(geometry, hostTriangle(geometry, primitive), p);
    return transformPoint(hostInstance(geometry).objectToWorld,
                          p[0] + (barycentrics.x * (p[1] - p[0]) + barycentrics.y * (p[2] - p[0])));
}

// The corners of a triangle in its mesh's space, with the numbers of their vertices.
struct TriangleCorners {
    uvec3 vertices;
    vec3 corners[3];
};

TriangleCorners vertexPositions(HostGeometry geometry, uint primitive) {
    TriangleCorners triangle;
    triangle.vertices = hostTriangle(geometry, primitive);
    hostPositions(geometry, triangle.vertices, triangle.corners);
    return triangle;
}

// Fetches the attributes that `features` may need. rayDirection is a unit vector; coneWidth is that of the ray cone at
// the hit.
Hit fetchHitAt(HostGeometry geometry, uint primitive, vec2 barycentrics, vec3 rayDirection, float coneWidth,
               uint target, Features features, TriangleCorners triangle) {
    InstanceRecord instance = hostInstance(geometry);
    uvec3 corner = triangle.vertices;
    vec3 weights = vec3(1.0 - barycentrics.x - barycentrics.y, barycentrics);
    bool mirrored = (instance.flags & kInstanceMirrored) != 0u;

    Hit hit;
    hit.view = -rayDirection;
    hit.material = materialOf(geometry, primitive);
    hit.target = target;

    // The position and the plane of the triangle. In object space, the front is counter-clockwise.
    vec3 p0 = triangle.corners[0];
    vec3 e1 = triangle.corners[1] - p0;
    vec3 e2 = triangle.corners[2] - p0;
    precise vec3 objectPosition = p0 + (barycentrics.x * e1 + barycentrics.y * e2);
    precise vec3 position = transformPoint(instance.objectToWorld, objectPosition);
    hit.position = position;
#if GLINT_ANSWERS_SURFACE
    hit.shaderId = geometry.shaderId;
    vec3 previousPosition = objectPosition;
#ifdef GLINT_HOST_PREVIOUS_POSITIONS
    previousPosition = weights.x * hostPreviousPosition(geometry, corner.x) +
                       weights.y * hostPreviousPosition(geometry, corner.y) +
                       weights.z * hostPreviousPosition(geometry, corner.z);
#endif
    hit.previousPosition = transformPoint(hostPreviousInstance(geometry).objectToWorld, previousPosition);
#endif
    hit.edges[0] = transformVector(instance.objectToWorld, e1);
    hit.edges[1] = transformVector(instance.objectToWorld, e2);
    vec3 front = directionOr(transformNormal(instance.normalToWorld, cross(e1, e2)), hit.view);
    hit.frontFace = dot(front, hit.view) >= 0.0;
    hit.geometricNormal = hit.frontFace ? front : -front;
    hit.clearance = planeError(front, TrianglePoint(p0, e1, e2, objectPosition), instance.objectToWorld,
                               instance.normalToWorld);
#if GLINT_PATHS
    hit.inset = edgeInset(weights, hit.edges[0], hit.edges[1], 2.0 * hit.clearance);
    hit.arrival.media = uvec2(0u);
    hit.arrival.start = hit.position;  // of a primary surface: no way within an object
#endif

    hit.normal = front;
    if (hasInput(features, GLINT_ROLE_NORMALS)) {
        vec3 normals[3];
        hostNormals(geometry, corner, normals);
        vec3 n = weights.x * normals[0] + weights.y * normals[1] + weights.z * normals[2];
        hit.normal = directionOr(transformNormal(instance.normalToWorld, n), front);
    }
    hit.tangent = vec4(0.0);
    if (hasInput(features, GLINT_ROLE_TANGENTS)) {
        vec4 tangents[3];
        hostTangents(geometry, corner, tangents);
        vec4 t = weights.x * tangents[0] + weights.y * tangents[1] + weights.z * tangents[2];
        float handedness = tangents[0].w;
        hit.tangent = vec4(transformVector(instance.objectToWorld, t.xyz), mirrored ? -handedness : handedness);
    }

    // The UV sets, with their edges for derived frames and for the level of detail.
    hit.texCoords[0] = vec2(0.0);
    hit.texCoords[1] = vec2(0.0);
    hit.uvEdges[0] = vec4(0.0);
    hit.uvEdges[1] = vec4(0.0);
    if (hasInput(features, GLINT_ROLE_TEX_COORD0)) {
        vec2 uv[3];
        hostTexCoords0(geometry, corner, uv);
        hit.texCoords[0] = weights.x * uv[0] + weights.y * uv[1] + weights.z * uv[2];
        hit.uvEdges[0] = vec4(uv[1] - uv[0], uv[2] - uv[0]);
    }
    if (hasInput(features, GLINT_ROLE_TEX_COORD1)) {
        vec2 uv[3];
        hostTexCoords1(geometry, corner, uv);
        hit.texCoords[1] = weights.x * uv[0] + weights.y * uv[1] + weights.z * uv[2];
        hit.uvEdges[1] = vec4(uv[1] - uv[0], uv[2] - uv[0]);
    }
    hit.color = vec4(1.0);
    if (hasInput(features, GLINT_ROLE_VERTEX_COLOR)) {
        vec4 colors[3];
        hostColors(geometry, corner, colors);
        hit.color = weights.x * colors[0] + weights.y * colors[1] + weights.z * colors[2];
    }

#if GLINT_VERTEX_ATTRIBUTES
    hit.attributes = fetchAttributes(geometry, corner, weights, features);
#endif

    vec3 across;
    vec3 along;
    coneAxes(coneWidth, rayDirection, hit.geometricNormal, across, along);
    hit.footprint = vec4(inEdges(across, hit.edges[0], hit.edges[1]), inEdges(along, hit.edges[0], hit.edges[1]));
    hit.scale = 1.0;
    if (boundsAbsorber(features)) {
        // The scale is the root mean square over the axes.
        vec3 x = instance.objectToWorld[0].xyz;
        vec3 y = instance.objectToWorld[1].xyz;
        vec3 z = instance.objectToWorld[2].xyz;
        hit.scale = sqrt((dot(x, x) + dot(y, y) + dot(z, z)) / 3.0);
    }
    return hit;
}

// Does the same for the triangle that was hit, whose corners a module may know already.
Hit fetchHit(HostGeometry geometry, uint primitive, vec2 barycentrics, vec3 rayDirection, float coneWidth,
             uint target, Features features) {
#ifdef GLINT_CORNER
    TriangleCorners triangle;
    triangle.vertices = hostTriangle(geometry, primitive);
    triangle.corners = vec3[3](GLINT_CORNER(0), GLINT_CORNER(1), GLINT_CORNER(2));
#else
    TriangleCorners triangle = vertexPositions(geometry, primitive);
#endif
    return fetchHitAt(geometry, primitive, barycentrics, rayDirection, coneWidth, target, features, triangle);
}
