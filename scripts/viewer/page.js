// Renders scenes with the Khronos glTF viewer and returns linear radiance. browser.py calls the functions
// that this module puts into `window`.
//
// The viewer's shading stays as it is. Only its output is changed:
//   - The canvas is replaced by a target of 32-bit floats, which is four times as wide and high as the picture. Each
//     pixel is the mean of its 4 x 4 samples. The canvas would clip at 1 and hold 8 bits.
//   - toneMap() returns the radiance, without the gamma curve.
//   - The picture of the opaque objects, in which the viewer looks up what is behind glass, has 16-bit floats instead
//     of 8 bits. Otherwise everything behind glass would be clipped at 1.
//   - The background is drawn as seen from the middle of the map. The viewer draws a cube as seen from a place beside
//     its middle, which makes directions wrong by up to a tenth. With this change both backgrounds are the same, and
//     compare.py checks by them that cameras and maps match.
import { GltfState, GltfView } from "/viewer/dist/gltf-viewer.module.js";

const SAMPLES = 4;  // per pixel in each direction
const BACKGROUND = 65535;  // the region of pixels that show no object; materials count from 1

const gl = document.createElement("canvas").getContext("webgl2");
const missing = ["EXT_color_buffer_float", "EXT_float_blend", "OES_texture_float_linear"]
    .filter((name) => !gl.getExtension(name));
if (missing.length > 0) {
    throw new Error(`WebGL lacks ${missing.join(", ")}`);
}

const view = new GltfView(gl);
const loader = view.createResourceLoader(undefined, undefined, "/viewer/dist/libs/");
const renderer = view.renderer;

// Replaces a text that must occur exactly once, so that another version of the viewer is an error.
function replaceInShader(shader, before, after) {
    const text = renderer.shaderCache.sources.get(shader);
    if (text.split(before).length !== 2) {
        throw new Error(`${shader} of the viewer does not have exactly one "${before}"`);
    }
    renderer.shaderCache.sources.set(shader, text.replace(before, () => after));
}

replaceInShader("cubemap.vert", "mat[3]=vec4(0.0,0.0,0.0,0.1);", "mat[3]=vec4(0.0);");

// A negative exposure asks for regions: its amount becomes the colour, and the cosine of the view becomes alpha.
for (const shader of ["pbr.frag", "cubemap.frag"]) {
    replaceInShader(shader, "vec3 toneMap(vec3 color){",
        "vec3 toneMap(vec3 color){if(u_Exposure<0.0){return vec3(-u_Exposure);}");
    replaceInShader(shader, "return linearTosRGB(color);}", "return color;}");
}
replaceInShader("pbr.frag", "vec4(toneMap(color),baseColor.a)",
    "vec4(toneMap(color),u_Exposure<0.0 ? NdotV : baseColor.a)");

let showsRegions = false;
const drawPrimitive = renderer.drawPrimitive.bind(renderer);
renderer.drawPrimitive = (state, configuration, primitive, ...rest) => {
    const exposure = state.renderingParameters.exposure;
    if (showsRegions) {
        state.renderingParameters.exposure = -(primitive.material + 1);
    }
    drawPrimitive(state, configuration, primitive, ...rest);
    state.renderingParameters.exposure = exposure;
};

const bindFramebuffer = gl.bindFramebuffer.bind(gl);
let target = null;
gl.bindFramebuffer = (kind, framebuffer) => bindFramebuffer(kind, framebuffer ?? target);

function makeTarget(width, height) {
    const framebuffer = gl.createFramebuffer();
    bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
    const formats = [[gl.COLOR_ATTACHMENT0, gl.RGBA32F], [gl.DEPTH_ATTACHMENT, gl.DEPTH_COMPONENT24]];
    for (const [attachment, format] of formats) {
        const buffer = gl.createRenderbuffer();
        gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
        gl.renderbufferStorage(gl.RENDERBUFFER, format, width, height);
        gl.framebufferRenderbuffer(gl.FRAMEBUFFER, attachment, gl.RENDERBUFFER, buffer);
    }
    if (gl.checkFramebufferStatus(gl.FRAMEBUFFER) !== gl.FRAMEBUFFER_COMPLETE) {
        throw new Error("WebGL can't render to 32-bit floats");
    }
    return { framebuffer, width, height };
}

// Gives the picture of the opaque objects 16-bit floats. The viewer makes it in init().
function widenOpaquePicture(state) {
    renderer.init(state);
    gl.bindTexture(gl.TEXTURE_2D, renderer.opaqueRenderTexture);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA16F, renderer.opaqueFramebufferWidth, renderer.opaqueFramebufferHeight, 0,
        gl.RGBA, gl.HALF_FLOAT, null);
    gl.bindTexture(gl.TEXTURE_2D, null);
    gl.bindRenderbuffer(gl.RENDERBUFFER, renderer.colorRenderBuffer);
    gl.renderbufferStorageMultisample(gl.RENDERBUFFER, renderer.samples, gl.RGBA16F, renderer.opaqueFramebufferWidth,
        renderer.opaqueFramebufferHeight);
}

function readTarget({ framebuffer, width, height }) {
    while (gl.getError() !== gl.NO_ERROR) {
        // The viewer makes calls that fail without a consequence, such as mips of compressed textures.
    }
    bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
    const pixels = new Float32Array(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.FLOAT, pixels);
    const error = gl.getError();
    if (error !== gl.NO_ERROR) {
        throw new Error(`WebGL reports the error ${error}`);
    }
    return pixels;
}

// Calls visit(pixel of the picture, offset of a sample) for every sample. WebGL has its first row below.
function forEachSample({ width, height }, visit) {
    for (let y = 0; y < height; ++y) {
        const row = Math.floor((height - 1 - y) / SAMPLES) * (width / SAMPLES);
        for (let x = 0; x < width; ++x) {
            visit(row + Math.floor(x / SAMPLES), 4 * (y * width + x));
        }
    }
}

// Returns red, green and blue of each pixel.
function meanRadiance(image, pixels) {
    const mean = new Float32Array(3 * image.width * image.height / SAMPLES ** 2);
    forEachSample(image, (pixel, sample) => {
        for (let channel = 0; channel < 3; ++channel) {
            mean[3 * pixel + channel] += pixels[sample + channel] / SAMPLES ** 2;
        }
    });
    return mean;
}

// Returns the region and the mean cosine of the view of each pixel. A pixel whose samples see several regions has 0.
function findRegions(image, pixels) {
    const regions = new Float32Array(2 * image.width * image.height / SAMPLES ** 2).fill(-1);
    forEachSample(image, (pixel, sample) => {
        const region = Number.isInteger(pixels[sample]) ? pixels[sample] : 0;
        const before = regions[2 * pixel];
        regions[2 * pixel] = before === -1 || before === region ? region : 0;
        regions[2 * pixel + 1] += (before === -1 ? 1 : 0) + pixels[sample + 3] / SAMPLES ** 2;
    });
    return regions;
}

// Converts in parts, because a call takes a limited number of arguments.
function toBase64(buffer) {
    const bytes = new Uint8Array(buffer);
    const parts = [];
    for (let begin = 0; begin < bytes.length; begin += 0x8000) {
        parts.push(String.fromCharCode(...bytes.subarray(begin, begin + 0x8000)));
    }
    return btoa(parts.join(""));
}

const state = view.createState();
Object.assign(state.renderingParameters, {
    clearColor: [0, 0, 0, 1],
    exposure: 1,
    usePunctual: false,
    useIBL: true,
    renderEnvironmentMap: true,
    blurEnvironmentMap: false,
    toneMap: GltfState.ToneMaps.NONE,
    environmentRotation: 0,  // the middle of the map is +X, as in Glint
});
state.animationIndices = [];

window.useEnvironment = async (map, sheenAlbedo) => {
    state.environment = await loader.loadEnvironment(map, { lut_sheen_E_file: sheenAlbedo });
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));  // waits until the map is filtered
};

window.useScene = async (scene) => {
    state.gltf = await loader.loadGltf(scene);
    state.sceneIndex = state.gltf.scene ?? 0;
    return state.gltf.materials.map((material) => material.name ?? "");
};

window.renderScene = (camera, width, height) => {
    if (target === null) {
        widenOpaquePicture(state);
    }
    const image = makeTarget(width * SAMPLES, height * SAMPLES);
    target = image.framebuffer;
    state.cameraIndex = camera;
    const pictures = [false, true].map((regions) => {
        showsRegions = regions;
        state.renderingParameters.exposure = regions ? -BACKGROUND : 1;
        view.renderFrame(state, image.width, image.height);
        return readTarget(image);
    });
    gl.deleteFramebuffer(image.framebuffer);
    return {
        radiance: toBase64(meanRadiance(image, pictures[0]).buffer),
        regions: toBase64(findRegions(image, pictures[1]).buffer),
    };
};
// Returns a picture as JPEG, in base64. The noise of traced pictures makes them large as PNG.
window.toJpeg = async (address) => {
    const bitmap = await createImageBitmap(await (await fetch(address)).blob());
    const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
    canvas.getContext("2d").drawImage(bitmap, 0, 0);
    const blob = await canvas.convertToBlob({ type: "image/jpeg", quality: 0.88 });
    return toBase64(await blob.arrayBuffer());
};

window.isReady = true;
