// The page: a mesh from its source on the stage, as the controls say.
//
//   source ─▶ mesh ─▶ models ─▶ stage
//   panel ─▶ requests, looks

import { checkerTexture } from './checker.js';
import { floats, plainPart, readData } from './data.js';
import { keys, listen } from './keys.js';
import { Materials } from './materials.js';
import { Model } from './model.js';
import { Panel, saveFile } from './panel.js';
import { plyFile } from './ply.js';
import { Program, Stops } from './source.js';
import { Stage } from './stage.js';
import { NO_DISTANCES, figures, labels, legend, toleranceWords } from './words.js';

// A slider that moves asks for no more meshes than this apart [ms].
const CALM = 120;
const GROUNDS = { light: ['#e9ecef', '#b3541e'], dark: ['#16191d', '#ffb27a'] };

class Viewer {
  constructor(data) {
    this.data = data;
    this.source = data.live ? new Program(data) : new Stops(data);
    this.panel = new Panel(data.name, {
      tolerance: () => this.toleranceChanged(),
      look: () => this.showLook(),
      shown: () => this.shownChanged(),
      animation: () => this.animate(),
      weight: (name, weight) => this.setWeight(name, weight),
      fit: () => this.stage?.fit(),
      save: (format) => this.save(format),
    });
    this.mesh = null;
    this.weights = new Map();
    const { places } = this.source;
    this.panel.setPlaces(places.last, places.nearest(data.start));
    if (data.left_out.length) {
      const most = `${data.most >> 20} MB`;
      this.panel.setMessage('page', `Left out, as the page would have more than ${most}: ${data.left_out.join(', ')}.`);
    }
  }

  async start() {
    this.openStage();
    this.showToleranceWords();
    if (this.source.isLive) {
      this.source.ended().then(() => this.end());
    }
    await this.refine();
  }

  openStage() {
    const { data, panel } = this;
    try {
      const cage = data.cage ? floats(plainPart(data.cage)) : new Float32Array();
      this.stage = new Stage(document.getElementById('canvas'), cage);
      this.materials = new Materials(checkerTexture());
      this.followSurroundings();
      const all = keys(panel, this.stage);
      panel.setKeys(all);
      listen(all);
      panel.setUsable({ cage: cage.length ? null : 'the page has no cage' });
    } catch (error) {
      this.stage = null;
      panel.showPicture(data.picture && plainPart(data.picture));
      panel.setMessage('browser', `This browser draws no meshes (WebGL 2: ${error.message}), so this is a picture.`);
      const why = 'this browser draws no meshes';
      const names = ['material', 'plain', 'distance', 'checker', 'wireframe', 'cage', 'side-by-side', 'fit', 'save-png', 'help'];
      panel.setUsable(Object.fromEntries(names.map((name) => [name, why])));
    }
  }

  followSurroundings() {
    const dark = matchMedia('(prefers-color-scheme: dark)');
    const follow = () => {
      const [ground, cage] = GROUNDS[dark.matches ? 'dark' : 'light'];
      this.stage.setGround(ground, cage);
      this.materials.setDark(dark.matches);
    };
    dark.addEventListener('change', follow);
    follow();
  }

  toleranceChanged() {
    this.showToleranceWords();
    this.panel.setBusy(true);
    clearTimeout(this.calm);
    this.calm = setTimeout(() => this.refine(), this.source.isLive ? CALM : 0);
  }

  showToleranceWords() {
    const { panel, source, data } = this;
    const tolerance = (source.isLive ? source : source.places).tolerance(panel.place);
    panel.setToleranceWords(toleranceWords(tolerance, data));
  }

  /** Gets the mesh that is wanted and shows it. The newest request wins; until then the mesh before it stays. */
  async refine() {
    this.request?.abort();
    const request = new AbortController();
    this.request = request;
    this.panel.setBusy(true);
    try {
      const mesh = await this.source.mesh(this.panel.place, this.panel.isSideBySide, request.signal);
      const models = this.stage ? await this.read(mesh) : [];
      if (this.request === request) {
        this.show(mesh, models);
        this.panel.setMessage('mesh', '');
      } else {
        models.forEach((model) => model?.dispose());
      }
    } catch (error) {
      if (this.request === request && error.name !== 'AbortError' && !this.isEnded) {
        this.panel.setMessage('mesh', error.message);
      }
    } finally {
      if (this.request === request) {
        this.panel.setBusy(false);
        this.panel.setFigures(this.mesh ? figures(this.mesh, this.data) : '');
      }
    }
  }

  /** The models of a mesh: itself and its uniform counterpart, or null. */
  async read({ glb, distances, uniform, uniformDistances }) {
    return [
      await Model.read(glb, distances, this.materials),
      uniform && (await Model.read(uniform, uniformDistances, this.materials)),
    ];
  }

  show(mesh, models) {
    const { panel, stage } = this;
    const isFirst = !this.mesh;
    this.mesh = mesh;
    panel.setNotes(mesh.report.words);
    if (!stage) {
      return;
    }
    const old = this.models ?? [];
    this.models = models;
    const [model] = models;
    panel.setUsable({
      material: model.hasMaterials ? null : 'the file has no materials',
      checker: model.hasTextureCoordinates ? null : 'the mesh has no texture coordinates',
      'side-by-side': this.source.hasUniform && !this.isEnded ? null : 'the page has no uniform mesh',
    });
    if (isFirst) {
      panel.setLook(model.hasMaterials ? 'material' : 'plain');
      panel.setAnimations(model.animations.map((clip, i) => clip.name || `animation ${i + 1}`));
      panel.setShapes(model.shapes().map((name) => ({ name, weight: model.weight(name) })));
    }
    models.forEach((own) => this.weights.forEach((weight, name) => own?.setWeight(name, weight)));
    this.animate();
    this.arrange();
    old.forEach((own) => own?.dispose());
  }

  /** Puts one model on the stage, or two side by side. */
  arrange() {
    const { panel, stage, models, mesh, data } = this;
    const isPair = panel.isSideBySide && Boolean(models[1]);
    panel.setLabels(isPair ? labels(mesh, data) : null);
    stage.setModels(isPair ? models : [models[0]]);
    this.showLook();
  }

  showLook() {
    const { panel, stage, models, materials, data } = this;
    if (!models) {
      return;
    }
    // One scale for both. Samples may miss what the report knows; and what is nearly nothing is to look so.
    const known = [data.diagonal * 1e-9, this.mesh.report.lower ?? 0];
    const greatest = Math.max(...known, ...stage.models.map((model) => model.greatestDistance ?? 0));
    materials.uniforms.greatestDistance.value = greatest;
    materials.uniforms.edgesShown.value = panel.isWireframe ? 0.75 : 0;
    models.forEach((model) => model?.setLook(panel.look));
    const map = models[0].greatestDistance === null ? { words: NO_DISTANCES } : legend(greatest, data);
    panel.setLegend(panel.look === 'distance' ? map : null);
    stage.setCage(panel.isCage);
  }

  shownChanged() {
    if (!this.models) {
      return;
    }
    if (this.panel.isSideBySide && !this.models[1] && this.source.isLive && !this.isEnded) {
      this.refine();
    } else {
      this.arrange();
    }
  }

  animate() {
    const { panel, stage, models } = this;
    const [model] = models;
    if (!model.animations.length) {
      return;
    }
    const time = stage.models[0]?.mixer.time ?? 0;
    models.forEach((own) => own?.setAnimation(panel.animation, time));
    stage.setPlaying(panel.isPlaying);
  }

  setWeight(name, weight) {
    this.weights.set(name, weight);
    this.models.forEach((model) => model?.setWeight(name, weight));
    this.stage.redraw();
  }

  async save(format) {
    const { panel, mesh, stage, source } = this;
    if (!mesh) {
      return;
    }
    const name = `${this.data.name.replace(/^builtin:/, '').replace(/\.[^.]*$/, '')}-refined.${format}`;
    try {
      panel.setMessage('file', '');
      switch (format) {
        case 'glb':
          return saveFile(name, mesh.glb, 'model/gltf-binary');
        case 'png':
          return saveFile(name, await stage.picture(), 'image/png');
        default:
          return saveFile(name, await this.ply(source), 'application/octet-stream');
      }
    } catch (error) {
      panel.setMessage('file', error.message);
    }
  }

  async ply(source) {
    if (source.isLive && !this.isEnded) {
      return source.file('ply', this.mesh.tolerance);
    }
    const model = this.models?.[0] ?? (await this.read(this.mesh))[0];
    return plyFile(model.meshes);
  }

  end() {
    this.isEnded = true;
    this.request?.abort();
    const { mesh, models, panel, source } = this;
    panel.end(source.places.nearest(mesh?.tolerance ?? this.data.start));
    this.showToleranceWords();
    if (!models?.[1]) {
      panel.setUsable({ 'side-by-side': 'the program has ended' });
    }
    panel.setMessage('program', 'The program has ended: this mesh stays, but no other will come.');
  }
}

const viewer = new Viewer(readData());
// For whoever looks at the page from its console.
window.limitmesh = viewer;
viewer.start();
