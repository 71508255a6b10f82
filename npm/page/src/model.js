// A GLB file as objects of a scene, with what can be switched: materials, animations, shapes.

import { AnimationMixer, BufferAttribute } from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';

export class Model {
  /** Reads a file; `distances` are those of its triangles, in the order of its primitives, or null. */
  static async read(glb, distances, materials) {
    // The loader keeps a view of the whole buffer.
    const { scene, animations, parser } = await new GLTFLoader().parseAsync(glb.slice().buffer, '');
    const hasMaterials = Boolean(parser.json.materials?.length);
    return new Model(scene, animations, hasMaterials, distances, materials);
  }

  constructor(scene, animations, hasMaterials, distances, materials) {
    this.scene = scene;
    this.animations = animations;
    this.materials = materials;
    this.meshes = [];
    scene.traverse((object) => object.isMesh && this.meshes.push(object));
    this.separateTriangles();
    this.greatestDistance = this.setDistances(distances);
    this.hasTextureCoordinates = this.meshes.some((mesh) => mesh.geometry.attributes.uv);
    this.hasMaterials = hasMaterials || this.meshes.some((mesh) => mesh.geometry.attributes.color);
    this.own = new Map(this.meshes.map((mesh) => [mesh, mesh.material]));
    this.own.forEach((material) => materials.withEdges(material));
    this.mixer = new AnimationMixer(scene);
  }

  /** Gives each triangle vertices of its own: edges and distances are drawn by them. */
  separateTriangles() {
    const separate = new Map();
    for (const mesh of this.meshes) {
      const { geometry } = mesh;
      if (!separate.has(geometry)) {
        const own = geometry.index ? geometry.toNonIndexed() : geometry;
        own.attributes.normal ?? own.computeVertexNormals();
        separate.set(geometry, own);
      }
      mesh.geometry = separate.get(geometry);
      // Bounds of skinned meshes would be found anew for each picture.
      mesh.frustumCulled = false;
    }
  }

  /** Puts distances at the triangles; gives the greatest, or null where there are none. */
  setDistances(distances) {
    const count = this.meshes.reduce((sum, mesh) => sum + triangles(mesh), 0);
    if (distances?.length !== count) {
      return null;
    }
    let at = 0;
    for (const mesh of this.meshes) {
      const ofCorners = new Float32Array(3 * triangles(mesh));
      for (let corner = 0; corner < ofCorners.length; corner++) {
        ofCorners[corner] = distances[at + Math.floor(corner / 3)];
      }
      at += triangles(mesh);
      mesh.geometry.setAttribute('distanceOfTriangle', new BufferAttribute(ofCorners, 1));
    }
    return distances.reduce((most, own) => Math.max(most, own), 0);
  }

  /** Widens a box so that it holds what is shown. */
  expand(box) {
    this.scene.updateWorldMatrix(false, true);
    // The bounds of shapes are those of all their weights; where there are some, each vertex is asked where it is.
    box.expandByObject(this.scene, this.meshes.some((mesh) => mesh.morphTargetInfluences));
  }

  /** Draws the surface in a way: 'material', 'plain', 'distance' or 'checker'. What the file lacks is drawn plain. */
  setLook(look) {
    for (const mesh of this.meshes) {
      mesh.material = this.materialOf(mesh, look);
    }
  }

  materialOf(mesh, look) {
    const { plain, distance, checker } = this.materials;
    switch (look) {
      case 'material':
        return this.hasMaterials ? this.own.get(mesh) : plain;
      case 'distance':
        return this.greatestDistance === null ? plain : distance;
      case 'checker':
        return mesh.geometry.attributes.uv ? checker : plain;
      default:
        return plain;
    }
  }

  /** Begins an animation at a time. */
  setAnimation(number, time) {
    this.mixer.stopAllAction();
    const clip = this.animations[number];
    if (clip) {
      this.mixer.clipAction(clip).play();
      this.mixer.setTime(time);
    }
  }

  /** The names of its shapes. */
  shapes() {
    const names = this.meshes.flatMap((mesh) => Object.keys(mesh.morphTargetDictionary ?? {}));
    return [...new Set(names)];
  }

  /** How much of a shape is in it now. */
  weight(name) {
    const mesh = this.meshes.find((own) => name in (own.morphTargetDictionary ?? {}));
    return mesh?.morphTargetInfluences[mesh.morphTargetDictionary[name]] ?? 0;
  }

  setWeight(name, weight) {
    for (const mesh of this.meshes) {
      const number = mesh.morphTargetDictionary?.[name];
      if (number !== undefined) {
        mesh.morphTargetInfluences[number] = weight;
      }
    }
  }

  /** Gives back what it holds of the graphics card. */
  dispose() {
    this.mixer.stopAllAction();
    for (const mesh of this.meshes) {
      mesh.geometry.dispose();
      mesh.skeleton?.dispose();
    }
    for (const material of this.own.values()) {
      Object.values(material).forEach((value) => value?.isTexture && value.dispose());
      material.dispose();
    }
  }
}

/** The number of a mesh's triangles. */
export function triangles(mesh) {
  return mesh.geometry.attributes.position.count / 3;
}
