// The controls around the picture: what they are set to, and what they say.

import { GRADIENT } from './colours.js';

const ARROWS = { ArrowLeft: '←', ArrowRight: '→', ArrowUp: '↑', ArrowDown: '↓' };

const by = (id) => document.getElementById(id);

export class Panel {
  /** `on` is called by the names of what changed: tolerance, look, shown, animation, weight, fit, save. */
  constructor(name, on) {
    this.on = on;
    this.messages = new Map();
    by('name').textContent = name;
    document.title = `${name} – limitmesh`;
    by('legend-bar').style.background = GRADIENT;
    by('controls').addEventListener('submit', (event) => event.preventDefault());
    by('tolerance').addEventListener('input', () => on.tolerance());
    by('looks').addEventListener('change', () => on.look());
    for (const id of ['wireframe', 'cage', 'side-by-side']) {
      by(id).addEventListener('change', () => on.shown());
    }
    by('play').addEventListener('click', () => this.togglePlay());
    by('animation').addEventListener('change', () => on.animation());
    by('fit').addEventListener('click', () => on.fit());
    for (const format of ['glb', 'ply', 'png']) {
      by(`save-${format}`).addEventListener('click', () => on.save(format));
    }
    by('help').addEventListener('click', () => this.showKeys());
  }

  get place() {
    return Number(by('tolerance').value);
  }

  get look() {
    return document.querySelector('input[name="look"]:checked').value;
  }

  get isWireframe() {
    return by('wireframe').checked;
  }

  get isCage() {
    return by('cage').checked;
  }

  get isSideBySide() {
    return by('side-by-side').checked;
  }

  get isPlaying() {
    return by('play').getAttribute('aria-pressed') === 'true';
  }

  get animation() {
    return Number(by('animation').value);
  }

  /** The slider's places; it is of no use with one. */
  setPlaces(last, place) {
    by('tolerance').max = last;
    by('tolerance').value = place;
    by('tolerance').hidden = last === 0;
  }

  /** From now on there is the mesh that is shown, at a place, and no other. */
  end(place) {
    by('tolerance').value = place;
    by('tolerance').disabled = true;
  }

  stepTolerance(step) {
    const { value } = by('tolerance');
    by('tolerance').value = Number(value) + step;
    if (by('tolerance').value !== value && !by('tolerance').disabled) {
      this.on.tolerance();
    }
  }

  setToleranceWords(words) {
    by('tolerance-words').textContent = words;
    by('tolerance').setAttribute('aria-valuetext', words);
  }

  setBusy(isBusy) {
    document.body.setAttribute('aria-busy', isBusy);
    if (isBusy) {
      by('figures').textContent = 'refining …';
    }
  }

  setFigures(words) {
    by('figures').textContent = words;
    by('canvas').setAttribute('aria-label', `the refined mesh: ${words}`);
  }

  /** What else there is to say of the mesh, behind a line that is opened. */
  setNotes(lines) {
    by('notes').hidden = lines.length === 0;
    by('notes-count').textContent = lines.length === 1 ? '1 note' : `${lines.length} notes`;
    by('notes-words').textContent = lines.join('\n');
  }

  /** What is wrong with something; an empty text takes it back. */
  setMessage(about, words) {
    this.messages.set(about, words);
    const all = [...this.messages.values()].filter(Boolean);
    by('message').textContent = all.join('\n');
    by('message').hidden = all.length === 0;
  }

  setLook(look) {
    this.lookOf(look).checked = true;
  }

  lookOf(look) {
    return document.querySelector(`input[name="look"][value="${look}"]`);
  }

  /** Which controls are of use, by their names, and why others are not. */
  setUsable(reasons) {
    for (const [name, why] of Object.entries(reasons)) {
      const control = this.lookOf(name) ?? by(name);
      control.disabled = why !== null;
      control.parentElement.title = why ?? '';
    }
  }

  /** Presses a control by its name, as a key does. */
  press(name) {
    const control = this.lookOf(name) ?? by(name);
    if (!control.closest('[hidden]')) {
      control.click();
    }
  }

  setLabels(labels) {
    [by('left-label'), by('right-label')].forEach((element, i) => {
      element.hidden = !labels;
      element.textContent = labels?.[i] ?? '';
    });
  }

  setLegend(legend) {
    by('legend').hidden = !legend;
    by('legend-scale').hidden = !legend?.marks;
    by('legend-words').textContent = legend?.words ?? '';
    if (legend?.marks) {
      const marks = legend.marks.map((mark) => element('li', mark));
      by('legend-ticks').replaceChildren(...marks);
    }
  }

  /** Lists the animations of a file, once. */
  setAnimations(names) {
    by('motion').hidden = names.length === 0;
    by('animation').hidden = names.length < 2;
    const options = names.map((name, i) => Object.assign(element('option', name), { value: i }));
    by('animation').replaceChildren(...options);
  }

  togglePlay() {
    by('play').setAttribute('aria-pressed', !this.isPlaying);
    by('play').textContent = this.isPlaying ? 'Hold' : 'Play';
    this.on.animation();
  }

  /** Lists the shapes of a file with their weights, once. */
  setShapes(shapes) {
    by('morphs').hidden = shapes.length === 0;
    const rows = shapes.map(({ name, weight }) => {
      const slider = Object.assign(element('input', ''), { type: 'range', min: 0, max: 1, step: 0.01, value: weight });
      slider.addEventListener('input', () => this.on.weight(name, Number(slider.value)));
      // A name that is a number is that of no name.
      const label = element('label', /^\d+$/.test(name) ? `shape ${Number(name) + 1}` : name);
      label.append(slider);
      return label;
    });
    by('morph-list').replaceChildren(...rows);
  }

  setKeys(keys) {
    const rows = new Map();
    for (const { names, words } of keys) {
      const shown = names.map((name) => ARROWS[name] ?? name.toUpperCase());
      rows.set(words, [...(rows.get(words) ?? []), ...shown]);
    }
    const cells = [...rows].flatMap(([words, names]) => [element('dt', names.join(' ')), element('dd', words)]);
    by('key-list').replaceChildren(...cells);
  }

  showKeys() {
    by('keys').showModal();
  }

  /** Shows a picture in place of the stage. */
  showPicture(png) {
    by('canvas').hidden = true;
    if (png) {
      by('picture').src = URL.createObjectURL(new Blob([png], { type: 'image/png' }));
      by('picture').alt = 'the smooth surface, drawn by limitmesh render';
      by('picture').hidden = false;
    }
  }
}

function element(name, text) {
  const own = document.createElement(name);
  own.textContent = text;
  return own;
}

/** Offers bytes as a file. */
export function saveFile(name, bytes, type) {
  const address = URL.createObjectURL(bytes instanceof Blob ? bytes : new Blob([bytes], { type }));
  const link = Object.assign(element('a', ''), { href: address, download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(address), 10_000);
}
