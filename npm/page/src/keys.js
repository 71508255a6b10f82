// The keys that the page listens to.

/** What each key does, in words and by the panel and the stage. */
export function keys(panel, stage) {
  return [
    { names: ['['], words: 'a coarser mesh', act: () => panel.stepTolerance(-1) },
    { names: [']'], words: 'a finer mesh', act: () => panel.stepTolerance(1) },
    { names: ['m'], words: 'its own materials', act: () => panel.press('material') },
    { names: ['n'], words: 'a plain surface', act: () => panel.press('plain') },
    { names: ['d'], words: 'distances from the limit surface', act: () => panel.press('distance') },
    { names: ['u'], words: 'a pattern by texture coordinates', act: () => panel.press('checker') },
    { names: ['w'], words: 'wireframe', act: () => panel.press('wireframe') },
    { names: ['c'], words: 'control cage', act: () => panel.press('cage') },
    { names: ['s'], words: 'uniform subdivision beside it', act: () => panel.press('side-by-side') },
    { names: ['p'], words: 'play or hold the animation', act: () => panel.press('play') },
    { names: ['f'], words: 'the whole mesh from the front', act: () => stage.fit() },
    { names: ['ArrowLeft'], words: 'turn', act: () => stage.turn(-1, 0) },
    { names: ['ArrowRight'], words: 'turn', act: () => stage.turn(1, 0) },
    { names: ['ArrowUp'], words: 'turn', act: () => stage.turn(0, 1) },
    { names: ['ArrowDown'], words: 'turn', act: () => stage.turn(0, -1) },
    { names: ['+', '='], words: 'nearer', act: () => stage.nearer(1) },
    { names: ['-'], words: 'farther', act: () => stage.nearer(-1) },
    { names: ['?'], words: 'these keys', act: () => panel.showKeys() },
  ];
}

/** Acts on keys, but where a control uses them itself. */
export function listen(all) {
  const byName = new Map(all.flatMap((key) => key.names.map((name) => [name, key])));
  addEventListener('keydown', (event) => {
    const key = byName.get(event.key.length === 1 ? event.key.toLowerCase() : event.key);
    const isTaken = event.key.startsWith('Arrow') && event.target.matches?.('input, select, summary');
    if (key && !isTaken && !event.ctrlKey && !event.metaKey && !event.altKey && !document.querySelector('dialog[open]')) {
      event.preventDefault();
      key.act();
    }
  });
}
