// Starts the viewer; where it cannot be, as without WebGL 2, the numbers below are all there is, and the page says why.

function start() {
  const copy = document.getElementById("copy");
  if (copy) copy.addEventListener("click", () => copyCommand(copy));
  try {
    window.geomdrapReport = new Viewer(readModel());
    document.documentElement.dataset.ready = "yes";
  } catch (error) {
    document.documentElement.dataset.ready = "no";
    document.getElementById("failed").hidden = false;
    const known = error instanceof NoWebGL;
    if (!known) console.error(error);
    document.getElementById("failed-why").textContent = known ? "this browser gives no WebGL 2" : error.message;
  }
}

async function copyCommand(button) {
  const code = document.getElementById("command");
  try {
    await navigator.clipboard.writeText(code.textContent);
    button.textContent = "Copied";
  } catch {
    getSelection().selectAllChildren(code); // where pages may not write to the clipboard the text is at least marked
    button.textContent = "Marked: press Ctrl+C";
  }
}

start();
