// Copyright 2026 The sdf_pose_bridge authors
// SPDX-License-Identifier: Apache-2.0
//
// Features of the page that viser does not have: frames and lines on top of bodies, labels without
// overlaps, names at the pointer, a strip over the scene, the opacity of bodies, copying, keys, and
// changes of several controls at once. The scene is found as the developer tools of three.js find
// it.
(() => {
  // viser sends a change at most every 50 ms, and of several in between only the last one: when
  // two controls change, one is lost. A microtask runs before the next event.
  const wait = window.setTimeout;
  window.setTimeout = (action, ms, ...rest) => ms === 50
    ? queueMicrotask(() => action(...rest)) : wait(action, ms, ...rest);
  let scene, frames, camera;
  window.__THREE_DEVTOOLS__ ??= new EventTarget();
  __THREE_DEVTOOLS__.addEventListener('observe', ({detail: observed}) => {
    if (observed.isScene) observed.onBeforeRender = (renderer, _, used) => {
      const {frames: names} = namesInScene(), opacity = Number(given('opacity', 1));
      observed.traverse(node => {
        // viser has no opacity for bodies with a texture, and makes others anew for it.
        if (node.isInstancedMesh2) {
          node.isTransparent ??= node.material.transparent;
          node.sortObjects = node.isTransparent || opacity < 1;
          Object.assign(node.material, {opacity, transparent: node.sortObjects});
        }
        // Lines to parents, and the measured one.
        if (node.isLineSegments2 && node.material.depthTest) {
          Object.assign(node.material, {depthTest: false, transparent: true});
          node.renderOrder = 8999;
        }
        // These are axes, and nothing else is.
        if (!node.isInstancedMesh || !node.material.isMeshBasicMaterial) return;
        if (node.count === 3 * names.length) [scene, frames, camera] = [observed, node, used];
        if (node.renderOrder) return;
        // Late, and with no depth of what was drawn before, they are on top of all bodies.
        node.renderOrder = 9000;
        node.material.transparent = true;
        node.onBeforeRender = drawing => drawing.clearDepth();
      });
      // Each time, as the panel takes its place late, and both can be resized.
      strip.style.maxWidth = `${renderer.domElement.clientWidth - 16}px`;
      if (frames?.parent) drawOver(renderer.domElement);
    };
  });
  const over = document.createElement('div');
  over.className = 'over-scene';
  over.innerHTML = `<svg class="axis-cross" viewBox="-30 -30 60 60"><path stroke="#d00"/>
    <path stroke="#4b1"/><path stroke="#00d"/></svg><div class="labels"></div>`;
  const [cross, labels] = over.children;
  const drawOver = canvas => {
    if (over.parentElement !== canvas.parentElement) canvas.parentElement.append(over);
    // The axes of the root frame, as the camera sees them.
    const m = camera.matrixWorldInverse.clone().multiply(frames.matrixWorld).elements;
    [0, 4, 8].forEach((i, axis) => cross.children[axis].setAttribute(
      'd', `M0 0 L${28 * m[i]} ${-28 * m[i + 1]}`));
    const placed = labelsWithoutOverlaps(canvas), drawn = JSON.stringify(placed);
    if (drawn === labels.dataset.drawn) return;
    labels.dataset.drawn = drawn;
    labels.replaceChildren(...placed.map(({lines, x, y}) => {
      const label = document.createElement('div');
      label.textContent = lines.join('\n');
      label.style.transform = `translate(${x}px, ${y}px)`;
      return label;
    }));
  };
  // The distance of a point in the root frame from the camera, and its place in pixels.
  const inPicture = (point, {clientWidth, clientHeight}) => {
    const at = frames.position.clone().set(...point).applyMatrix4(frames.matrixWorld);
    const depth = -at.clone().applyMatrix4(camera.matrixWorldInverse).z;
    const {x, y} = at.project(camera);
    return {depth, x: (0.5 + 0.5 * x) * clientWidth, y: (0.5 - 0.5 * y) * clientHeight};
  };
  const labelOf = (texts, x, y) => {
    const more = texts.length - 4;
    const lines = [...texts.slice(0, 4), ...(more > 0 ? [`and ${more} more`] : [])];
    return {texts, lines, x, y, right: x + 6.5 * Math.max(...lines.map(line => line.length)),
            bottom: y + 14 * lines.length};
  };
  // Names at one place are lines of one text; of others, those that would overlap are left out,
  // and their number is in a corner.
  const labelsWithoutOverlaps = canvas => {
    const {labels: all, unlisted} = JSON.parse(given('labels', '{"labels": [], "unlisted": 0}'));
    const seen = all.map(([text, isFirst, ...point]) => {
      const {depth, x, y} = inPicture(point, canvas);
      return [!isFirst, depth, labelOf([text], Math.round(x), Math.round(y))];
    }).filter(([, depth, {x, y}]) => depth > 0
      && x >= 0 && x <= canvas.clientWidth && y >= 0 && y <= canvas.clientHeight
    ).sort(([a, near], [b, far]) => a - b || near - far);
    const isOn = (a, b) => a.x < b.right && b.x < a.right && a.y < b.bottom && b.y < a.bottom;
    const placed = [];
    for (const [, , label] of seen) {
      const k = placed.findIndex(other => isOn(other, label)), other = placed[k];
      if (!other) placed.push(label);
      else if (Math.hypot(other.x - label.x, other.y - label.y) < 14) {
        const grown = labelOf([...other.texts, ...label.texts], other.x, other.y);
        if (placed.every((each, i) => i === k || !isOn(each, grown))) placed[k] = grown;
      }
    }
    const leftOut = placed.reduce((sum, {texts}) => sum - texts.length, seen.length + unlisted);
    const note = `${leftOut} more name${leftOut > 1 ? 's do' : ' does'} not fit; the page of `
      + '"sdf_pose view" shows names at the pointer';
    return leftOut ? [...placed, labelOf([note], 8, 8)] : placed;
  };
  const given = (name, otherwise) =>
    document.querySelector(`[data-${name}]`)?.dataset[name] ?? otherwise;
  let listed, names;
  const namesInScene = () => {
    const text = given('names', '{"frames": [], "bodies": []}');
    if (text !== listed) [listed, names] = [text, JSON.parse(text)];
    return names;
  };
  const namesOfFramesAt = (event, box) => {
    const half = 0.5 * frames.geometry.parameters.height, m = frames.instanceMatrix.array;
    const found = [];
    for (let k = 0; k < Math.min(frames.count / 3, 20000); k++) {
      // The origin is where the cylinder of the first axis begins.
      const {depth, x, y} = inPicture(
        [0, 1, 2].map(i => m[48 * k + 12 + i] - half * m[48 * k + 4 + i]), event.target);
      const distance = Math.hypot(x + box.left - event.clientX, y + box.top - event.clientY);
      if (depth > 0 && distance < 12) found.push([distance, namesInScene().frames[k]]);
    }
    found.sort(([a], [b]) => a - b);
    return found.slice(0, 8).map(([, name]) => name).join('\n')
      + (found.length > 8 ? `\nand ${found.length - 8} more` : '');
  };
  // The name of the body at the pointer, and the point of it there, in the root frame.
  const bodyAt = (event, box) => {
    const meshes = [], {bodies} = namesInScene(), {raycaster} = scene.__r3f.root.getState();
    scene.traverse(node => node.isInstancedMesh2 && meshes.push(node));
    raycaster.setFromCamera({
      x: 2 * (event.clientX - box.left) / box.width - 1,
      y: 1 - 2 * (event.clientY - box.top) / box.height}, camera);
    const [hit] = raycaster.intersectObjects(meshes, false);
    // Surfaces are the last nodes of the drawing, which has the axes in it too.
    const above = new Set();
    for (let node = frames; node; node = node.parent) above.add(node);
    let node = hit?.object;
    while (node && !above.has(node.parent)) node = node.parent;
    if (!node) return {};
    const nodes = node.parent.children;
    const before = bodies.slice(0, nodes.indexOf(node) - nodes.length + bodies.length).flat();
    const number = before.length + hit.instanceId;
    return {name: bodies.flat()[number], number,
            // hit.point is in the frame of the copies.
            point: frames.worldToLocal(raycaster.ray.at(hit.distance, hit.point)).toArray()};
  };
  const shown = document.createElement('div');
  shown.className = 'name-at-pointer';
  shown.style = 'position:fixed;z-index:9;pointer-events:none;padding:1px 5px;'
    + 'font:13px sans-serif;background:#212529;color:#fff;white-space:pre;display:none';
  const show = (event, text) => {
    shown.textContent = text;
    Object.assign(shown.style, {
      display: text ? 'block' : 'none', left: `${event.clientX + 14}px`,
      top: `${event.clientY + 8}px`});
    document.body.append(shown);
  };
  let resting;
  addEventListener('pointermove', event => {
    clearTimeout(resting);
    const canvas = event.target;
    if (event.buttons || canvas.tagName !== 'CANVAS' || !frames?.parent) return show(event, '');
    const box = canvas.getBoundingClientRect(), text = namesOfFramesAt(event, box);
    show(event, text);
    // A body is looked for when the pointer rests, as that takes long in a large scene.
    if (!text) resting = setTimeout(() => show(event, bodyAt(event, box).name ?? ''), 100);
  });
  // It is typed into a control that is not seen, with a number, as the same text is no change.
  const asked = () => document.querySelector('div:has(> .asked) + * input');
  const tell = (...asks) => {
    Object.getOwnPropertyDescriptor(HTMLInputElement.prototype, 'value').set.call(
      asked(), `${performance.now()} ${JSON.stringify(asks)}`);
    asked().dispatchEvent(new Event('input', {bubbles: true}));
  };
  // What the tab shows, as requests for the page of the next start.
  const shownNow = () => {
    const at = point => frames.worldToLocal(point.clone()).toArray();
    const {controls} = scene?.__r3f.root.getState() ?? {};
    return [...JSON.parse(given('kept', '[]')), ...controls && frames.parent ? [
      ['camera', ...at(camera.position), ...at(controls.getTarget(camera.position.clone()))]] : []];
  };
  let hasEnded = false, kept;
  // viser connects in a worker, which tells the page.
  const ViserWorker = window.Worker;
  window.Worker = class extends ViserWorker {
    constructor(...options) {
      super(...options);
      this.addEventListener('message', ({data: {type}}) => {
        if (type === 'connected') {
          const {matches: isDark} = matchMedia('(prefers-color-scheme: dark)');
          kept = sessionStorage.kept ? JSON.parse(sessionStorage.kept)
            : given('kept') ? shownNow() : [['set', 'dark background', isDark]];
          delete sessionStorage.kept;
        }
        if (type === 'connected' || type === 'closed') { hasEnded = type === 'closed'; update(); }
      });
    }
  };
  // The page of the same file may be served again, at an address that its key and a salt give.
  const follow = async () => {
    const salt = (await fetch('/')).headers.get('Salt');
    if (!salt) return;
    const text = new TextEncoder().encode(given('key') + salt + location.host);
    const bytes = new Uint8Array(await crypto.subtle.digest('SHA-256', text));
    const digits = [...bytes].map(byte => byte.toString(16).padStart(2, '0')).join('');
    const address = `/${digits.slice(0, 32)}/`;
    // The program that ends may still answer.
    if (address === location.pathname) return;
    if (!(await fetch(address)).ok || !hasEnded) return;
    sessionStorage.kept = JSON.stringify(shownNow());
    location.replace(address);
  };
  setInterval(() => { if (hasEnded && !document.hidden) follow().catch(() => {}); }, 500);
  const strip = document.createElement('div');
  strip.className = 'strip';
  let shownInStrip = '', selected;
  const SEARCH = 'div:has(+ div > .rows) input';
  const FIELD = 'div:has(> .frame-of-numbers) ~ div input';
  const FOLDER = '.mantine-Paper-root > .mantine-Paper-root:first-child';
  // The element with the keyboard, the last field, and the element that shall have the keyboard.
  let focused, field, awaited;
  addEventListener('focusin', ({target}) => {
    [focused, field] = [target, target.matches(FIELD) ? target : field];
  });
  let pressed;
  addEventListener('pointerdown', event => {
    focused = awaited = null;
    pressed = event;
  });
  addEventListener('click', event => {
    const canvas = event.target, isDrag = pressed && Math.hypot(
      event.clientX - pressed.clientX, event.clientY - pressed.clientY) > 3;
    if (given('points') !== 'True' || canvas.tagName !== 'CANVAS' || isDrag) return;
    const {name, number, point} = bodyAt(event, canvas.getBoundingClientRect());
    if (name) tell(['point', number, ...point]);
  });
  const updateFocus = row => {
    (row ?? document.querySelector('.rows [data-ask^=select]'))?.setAttribute('tabindex', 0);
    const {ask} = focused?.dataset ?? {};
    if (ask && !focused.isConnected) {
      (document.querySelector(`[data-ask="${CSS.escape(ask)}"]`) ?? field)?.focus();
    }
    const found = awaited && document.querySelector(awaited);
    if (found) awaited = null;
    found?.focus();
    if (found?.matches('.rows *')) found.click();
  };
  const moveInTree = (button, key) => {
    const row = button.closest('.rows > div'), isAcross = /Left|Right/.test(key);
    const others = isAcross ? [...row.querySelectorAll('button:not(:empty)')]
      : [...row.parentElement.querySelectorAll('[data-ask^=select]')];
    const at = others.findIndex(other => isAcross ? other === button : row.contains(other));
    others[at + (/Left|Up/.test(key) ? -1 : 1)]?.focus();
  };
  // viser's labels do not belong to their controls, and its folders open by a click alone.
  const nameControls = () => {
    for (const label of document.querySelectorAll('p > label')) {
      label.closest('.mantine-Flex-root').querySelectorAll('[role=slider], input').forEach(
        control => control.setAttribute('aria-label', label.textContent));
    }
    for (const [found, attributes] of Object.entries({
      canvas: {role: 'img', 'aria-label': 'frames and shapes'},
      'svg:not([aria-hidden])': {'aria-hidden': true},
      '.mantine-CloseButton-root': {'aria-label': 'close'},
      '[data-dock-header] .mantine-ActionIcon-root': {'aria-label': 'settings of the view'},
      [FOLDER]: {role: 'button', tabindex: 0},
      // A hint of viser is over the title and its icons.
      [SEARCH]: {placeholder: 'or click on a frame'},
    })) for (const element of document.querySelectorAll(found)) {
      Object.entries(attributes).forEach(([name, value]) => element.setAttribute(name, value));
      if (found === FOLDER) element.ariaExpanded = element.nextSibling?.ariaHidden !== 'true';
    }
  };
  const update = () => {
    nameControls();
    if (kept && asked()) {
      tell(['width', innerWidth], ...kept);
      kept = null;
    }
    const row = document.querySelector('.rows .selected'), rows = row?.closest('.rows');
    if (row && row.dataset.ask !== selected) {
      rows.scrollTop = row.offsetTop - rows.offsetTop - 0.5 * rows.clientHeight;
    }
    selected = row?.dataset.ask;
    const text = hasEnded
      ? '<b>sdf_pose view has ended; start it again, or open the page that it names</b>'
      : given('errors', '') + given('strip', '');
    if (text !== shownInStrip) {
      shownInStrip = strip.innerHTML = text;
      document.body.append(strip);
      document.body.style.setProperty('--strip', `${strip.offsetHeight}px`);
      if (document.activeElement === field) field.scrollIntoView({block: 'nearest'});
    }
    updateFocus(row);
  };
  new MutationObserver(update).observe(
    document, {childList: true, subtree: true, attributeFilter: ['aria-hidden']});
  // Behind the controls and before viser, whose camera also turns by the arrow keys.
  addEventListener('DOMContentLoaded', () => document.body.addEventListener('keydown', event => {
    const {target, key} = event;
    awaited = null;
    if (/^(Enter| )$/.test(key) && target.matches(FOLDER)) {
      event.preventDefault();
      target.click();
    }
    if (key === 'Escape' && given('points') === 'True') tell(['set', 'measure points', false]);
    if (!target.closest('[role=slider], input, textarea, .rows, .strip')) return;
    event.stopPropagation();
    // Otherwise the same key presses the button that gets the keyboard.
    if (key === 'Enter' && target.matches('input')) event.preventDefault();
    if (key === 'Enter' && target.matches(SEARCH)) {
      awaited = `.rows[data-search="${CSS.escape(target.value)}"] [data-ask^=select]`;
    } else if (key === 'Enter' && target.matches(FIELD)) {
      awaited = '.strip :is([data-ask^=write], [data-ask=cancel])';
    } else if (key === 'Escape' && (target.matches(FIELD) || target.closest('.strip'))) {
      tell(['cancel']);
    } else if (key.startsWith('Arrow') && target.closest('.rows')) {
      event.preventDefault();
      moveInTree(target, key);
    }
    update();
  }));
  addEventListener('pointerover', ({target}) => {
    const path = given('path');
    if (path && target.textContent === document.title) target.title = path;
  });
  addEventListener('click', ({target}) => {
    const {copy, ask} = target.closest?.('[data-copy], [data-ask]')?.dataset ?? {};
    if (copy) navigator.clipboard.writeText(copy).then(() => {
      target.textContent = 'copied';
      setTimeout(() => { target.textContent = 'copy'; }, 1000);
    });
    if (ask) tell(/^(select|fold|hide) ([^]*)/.exec(ask)?.slice(1) ?? [ask]);
  });
})();
