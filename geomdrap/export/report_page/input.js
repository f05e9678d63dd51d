// Mouse, touch and keys.

const KEY_TURN = 10;
const KEY_PAN = 40;
const KEY_ZOOM = 1.25;

// Pointers on a view: hover reads, one drags, two pinch, the wheel zooms.
function listen(view, viewer) {
  const { panel, camera } = view;
  const held = new Map();
  const local = (event) => {
    const box = panel.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };
  const changed = () => {
    view.fitted = false;
    view.moved();
    viewer.redraw();
  };
  panel.addEventListener("contextmenu", (event) => event.preventDefault());
  panel.addEventListener("pointerdown", (event) => {
    panel.setPointerCapture(event.pointerId);
    held.set(event.pointerId, local(event));
    if (event.pointerType !== "mouse") viewer.read(view, ...local(event));
  });
  for (const name of ["pointerup", "pointercancel"]) {
    panel.addEventListener(name, (event) => held.delete(event.pointerId));
  }
  panel.addEventListener("pointermove", (event) => {
    const [x, y] = local(event);
    const before = held.get(event.pointerId);
    if (!before) {
      viewer.read(view, x, y);
      return;
    }
    const others = [...held.entries()].filter(([id]) => id !== event.pointerId).map(([, place]) => place);
    held.set(event.pointerId, [x, y]);
    if (others.length) pinch(camera, others[0], before, [x, y]);
    else if (view.flatView || event.shiftKey || event.buttons & 6) camera.pan(x - before[0], y - before[1]);
    else camera.turn(0.4 * (x - before[0]), 0.4 * (y - before[1]));
    changed();
  });
  panel.addEventListener("pointerleave", (event) => {
    if (event.pointerType === "mouse" && !held.size) viewer.read(null);
  });
  panel.addEventListener("wheel", (event) => {
    event.preventDefault();
    const lines = event.deltaMode === 1 ? 16 : 1;
    camera.zoom(Math.exp(-0.0015 * lines * event.deltaY), ...local(event));
    changed();
  }, { passive: false });
  panel.addEventListener("dblclick", () => {
    view.fit();
    viewer.redraw();
  });
  panel.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (pressed(view, viewer, event)) event.preventDefault();
  });
}

function pinch(camera, fixed, before, now) {
  const [was, is] = [before, now].map(([x, y]) => Math.hypot(x - fixed[0], y - fixed[1]) || 1);
  camera.zoom(is / was, (fixed[0] + now[0]) / 2, (fixed[1] + now[1]) / 2);
  camera.pan((now[0] - before[0]) / 2, (now[1] - before[1]) / 2);
}

// Keys of a view that has the focus; true if the key meant something.
function pressed(view, viewer, event) {
  const arrow = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
  const { camera } = view;
  if (arrow && view.flatView) {
    viewer.step(arrow[0], -arrow[1], event.shiftKey ? 10 : 1);
    return true;
  }
  if (arrow && event.shiftKey) camera.pan(-KEY_PAN * arrow[0], -KEY_PAN * arrow[1]);
  else if (arrow) camera.turn(KEY_TURN * arrow[0], KEY_TURN * arrow[1]);
  else if (event.key === "+" || event.key === "=") camera.zoom(KEY_ZOOM);
  else if (event.key === "-") camera.zoom(1 / KEY_ZOOM);
  else if (event.key === "0" || event.key === "Home") view.fit();
  else return viewer.shortcut(event.key);
  if (event.key !== "0" && event.key !== "Home") view.fitted = false;
  view.moved();
  viewer.redraw();
  return true;
}
