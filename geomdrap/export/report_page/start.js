// Starts the viewer; without WebGL 2 the numbers below are all there is, and the page says so.

function start() {
  const copy = document.getElementById("copy");
  if (copy) copy.addEventListener("click", () => copyCommand(copy));
  try {
    window.geomdrapReport = new Viewer(readModel());
    document.documentElement.dataset.ready = "yes";
  } catch (error) {
    document.documentElement.dataset.ready = "no";
    document.getElementById("failed").hidden = false;
    document.getElementById("failed-why").textContent = error.message;
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
