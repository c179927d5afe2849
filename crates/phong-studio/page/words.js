// Every word that the page shows, in one place for who translates it.

export const words = {
  title: "phong studio",
  file: "Scene",
  picture: "Picture",
  pictureHelp:
    "The picture. Arrow keys turn it, with Shift they move it, plus and minus bring it nearer and " +
    "further. Click a pixel to have it explained.",
  progress: "How much of the picture is drawn",
  reset: "Back to the text",
  stop: "Stop",
  resume: "Go on",
  png: "PNG",
  exr: "EXR",
  toml: "TOML",
  copy: "Copy the command",
  copied: "The command is on the clipboard.",
  help:
    "Drag to turn, with Shift or two fingers to move, wheel or pinch to come nearer. Click a pixel " +
    "to keep it explained.",
  explained: "Why is this pixel this colour?",
  x: "x",
  y: "y",
  explain: "Explain",
  follow: "follow the pointer",
  controls: "What can be changed",
  text: "The scene's text",
  diagnostics: "What there is to say about the text",
  nothing: "Point at the picture.",
  background: "The ray meets nothing and sees the background.",
  at: "at",
  of: "of material",
  model: "model",
  light: "light",
  unseen: "not seen",
  behind: "behind",
  sum: "Sum",
  linear: "linear",
  shown: "in the picture",
  mirror: "mirror ray",
  glass: "refracted ray",
  weight: "weight",
  brought: "brought",
  line: "line",
  connecting: "Connecting …",
  lost: "The studio has gone. Start `phong studio` again, and open the address that it prints.",
  failed: "This was too much for the engine in this page, and it was started anew: ",
  noEngine: "The engine of this page cannot be loaded: ",
  old: "The page and the program are of different versions: load the page again.",
  drawing: (samples, of) => (samples === 0 ? "Drawing: a first look" : `Drawing: ${samples} of ${of} samples`),
  done: (samples) => `Done: ${samples} samples a pixel`,
  stopped: "Stopped",
  broken: "The text cannot be drawn as it is; the picture is the last that could.",
  groups: { image: "Picture", camera: "Camera", ambient: "Ambient light", light: "Light", materials: "Material" },
};

// Puts the words in their places.
export function fill(root) {
  for (const element of root.querySelectorAll("[data-word]")) {
    element.textContent = words[element.dataset.word];
  }
  for (const element of root.querySelectorAll("[data-label]")) {
    element.setAttribute("aria-label", words[element.dataset.label]);
  }
}
