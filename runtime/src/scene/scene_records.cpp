#include "scene/scene_records.h"

namespace glint {

void SceneRecords::followLights(std::span<const gpu::LightRecord> records,
                                std::span<const InstanceView> poses, TreeChange change) {
    glint::followLights(records, poses, change, emitters, lightTree);
    lightNodes.replace(lightTree.nodes);
    emitterRecords.replace(emitters.records);
}

void SceneRecords::countLights() {
    counts = {lights.count(), emitterRecords.count(), lightTree.treeNodes, lightTree.apart};
}

void SceneRecords::fill(gpu::FrameConstants& constants) const {
    constants.geometries = geometries.device.address;
    constants.instances = instances.device.address;
    constants.materials = materials.device.address;
    constants.lights = lights.device.address;
    constants.lightCount = counts.lights;
    constants.lightNodes = lightNodes.device.address;
    constants.lightTreeNodes = counts.treeNodes;
    constants.lightsApart = counts.apart;
    constants.emitters = emitterRecords.device.address;
    constants.firstEmitters = firstEmitters.device.address;
    constants.emitterCount = counts.emitters;
}

}  // namespace glint
