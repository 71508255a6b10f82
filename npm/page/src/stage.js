// The picture: one camera, one or two models side by side, and the control cage.

import {
  Box3,
  BufferAttribute,
  BufferGeometry,
  Color,
  DirectionalLight,
  Group,
  LineBasicMaterial,
  LineSegments,
  NeutralToneMapping,
  PerspectiveCamera,
  PMREMGenerator,
  Scene,
  Spherical,
  Vector3,
  WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { RoomEnvironment } from 'three/addons/environments/RoomEnvironment.js';

// From the front, a little from the right and above, as the program's pictures are.
const FROM = new Vector3(0.45, 0.4, 1).normalize();
const FIELD_OF_VIEW = 30;
// How much farther away than where all just fits.
const ROOM = 1.08;
const TURN = Math.PI / 24;
const STEP_NEARER = 1.15;

export class Stage {
  /** Throws where the browser cannot draw. */
  constructor(canvas, cage) {
    this.canvas = canvas;
    this.renderer = new WebGLRenderer({ canvas, antialias: true });
    this.renderer.toneMapping = NeutralToneMapping;
    this.renderer.setScissorTest(true);
    this.camera = new PerspectiveCamera(FIELD_OF_VIEW, 1, 0.01, 100);
    // It shines past the viewer's right ear.
    const light = new DirectionalLight(0xffffff, 1.3);
    light.position.set(0.4, 0.6, 1);
    this.camera.add(light, light.target);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener('change', () => this.redraw());
    this.fieldOfView = FIELD_OF_VIEW;
    this.models = [];
    this.scene = this.emptyScene();
    this.cage = cageLines(cage);
    this.cage.visible = false;
    this.lastTime = null;
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
    this.resize();
  }

  emptyScene() {
    const scene = new Scene();
    const environment = new PMREMGenerator(this.renderer).fromScene(new RoomEnvironment(), 0.04);
    scene.environment = environment.texture;
    scene.environmentIntensity = 0.55;
    scene.add(this.camera);
    return scene;
  }

  /** Shows models from the left to the right. The camera stays, but for the first ones. */
  setModels(models) {
    const isFirst = this.models.length === 0;
    this.scene.remove(...this.models.map((own) => own.scene));
    this.models = models;
    if (isFirst) {
      this.fit();
    }
    this.redraw();
  }

  setCage(isShown) {
    this.cage.visible = isShown;
    this.redraw();
  }

  setGround(colour, cageColour) {
    this.scene.background = new Color(colour);
    this.cage.children.forEach((lines) => lines.material.color.set(cageColour));
    this.redraw();
  }

  /** Turns the camera so that all is seen from the front. */
  fit() {
    this.look(FROM, FIELD_OF_VIEW);
  }

  /** Looks at the middle of what is shown from a direction, so far away that all is seen. */
  look(from, fieldOfView) {
    const box = new Box3();
    this.models.forEach((model) => model.expand(box));
    if (box.isEmpty()) {
      return;
    }
    const { camera, controls } = this;
    box.getCenter(controls.target);
    this.fieldOfView = fieldOfView;
    this.shapeCamera();
    camera.position.copy(controls.target).add(from);
    camera.lookAt(controls.target);
    const distance = ROOM * this.distanceFor(box);
    const radius = box.getSize(new Vector3()).length() / 2;
    camera.position.copy(controls.target).addScaledVector(from.clone().normalize(), distance);
    camera.near = Math.max(distance - 10 * radius, distance / 1000);
    camera.far = distance + 100 * radius;
    camera.updateProjectionMatrix();
    controls.update();
    this.redraw();
  }

  /** From how far away a camera that looks as it does now sees all corners of a box around its target. */
  distanceFor(box) {
    const { camera, controls } = this;
    const up = Math.tan((camera.fov * Math.PI) / 360);
    const toCamera = camera.quaternion.clone().invert();
    const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((i) => {
      const corner = new Vector3(...['x', 'y', 'z'].map((axis, k) => ((i >> k) & 1 ? box.max : box.min)[axis]));
      const { x, y, z } = corner.sub(controls.target).applyQuaternion(toCamera);
      return z + Math.max(Math.abs(x) / (up * camera.aspect), Math.abs(y) / up);
    });
    return Math.max(...corners);
  }

  /** Turns to the right and upwards, in steps. */
  turn(right, up) {
    this.moveCamera((spherical) => {
      spherical.theta -= right * TURN;
      spherical.phi -= up * TURN;
      spherical.makeSafe();
    });
  }

  /** Goes nearer, in steps. */
  nearer(steps) {
    this.moveCamera((spherical) => {
      spherical.radius *= STEP_NEARER ** -steps;
    });
  }

  moveCamera(change) {
    const { position } = this.camera;
    const { target } = this.controls;
    const spherical = new Spherical().setFromVector3(position.clone().sub(target));
    change(spherical);
    position.setFromSpherical(spherical).add(target);
    this.controls.update();
    this.redraw();
  }

  resize() {
    const { clientWidth, clientHeight } = this.canvas.parentElement;
    if (clientWidth === 0 || clientHeight === 0) {
      return;
    }
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.draw();
  }

  /** Draws before the next picture of the screen. */
  redraw() {
    this.frame ??= requestAnimationFrame((time) => {
      this.frame = null;
      this.draw();
      this.move(time);
    });
  }

  /** Plays or holds the models' animations. */
  setPlaying(isPlaying) {
    this.isPlaying = isPlaying;
    this.lastTime = null;
    this.redraw();
  }

  move(time) {
    if (!this.isPlaying) {
      return;
    }
    const passed = this.lastTime === null ? 0 : (time - this.lastTime) / 1000;
    this.lastTime = time;
    this.models.forEach((model) => model.mixer.update(passed));
    this.redraw();
  }

  /** Gives the camera the shape of a model's part of the picture. */
  shapeCamera() {
    const { clientWidth, clientHeight } = this.canvas.parentElement;
    const width = clientWidth / Math.max(1, this.models.length);
    this.camera.aspect = width / clientHeight;
    // The angle is that of the shorter side, so that what was seen in a wide picture is seen in a narrow one.
    const half = Math.tan((this.fieldOfView * Math.PI) / 360) / Math.min(1, this.camera.aspect);
    this.camera.fov = (Math.atan(half) * 360) / Math.PI;
    this.camera.updateProjectionMatrix();
    return [width, clientHeight];
  }

  draw() {
    const [width, height] = this.shapeCamera();
    const others = [...this.models.map((model) => model.scene), this.cage];
    this.models.forEach((model, number) => {
      this.scene.remove(...others);
      this.scene.add(model.scene, this.cage);
      this.renderer.setViewport(number * width, 0, width, height);
      this.renderer.setScissor(number * width, 0, width, height);
      this.renderer.render(this.scene, this.camera);
    });
  }

  /** The picture as a PNG file. */
  picture() {
    // What was drawn is there until the browser shows it.
    this.draw();
    return new Promise((resolve) => this.canvas.toBlob(resolve, 'image/png'));
  }
}

/** The cage's edges: strong where they are before the surface, faint behind it. */
function cageLines(points) {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(points, 3));
  const before = new LineBasicMaterial();
  const behind = new LineBasicMaterial({ depthTest: false, transparent: true, opacity: 0.3 });
  const lines = new LineSegments(geometry, before);
  const cage = new Group();
  const faint = new LineSegments(geometry, behind);
  faint.renderOrder = 1;
  cage.add(lines, faint);
  return cage;
}
