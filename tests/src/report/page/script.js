"use strict";
// What a point or bar stands for, when it is pointed at, touched or reached by the keyboard.
const tip = document.createElement("div");
tip.className = "tip";
tip.hidden = true;
document.body.append(tip);
for (const mark of document.querySelectorAll(".mark")) {
  const title = mark.querySelector("title");
  const words = title.textContent;
  // Else the browser shows its own beside ours.
  title.remove();
  mark.setAttribute("aria-label", words);
  const show = () => {
    const box = mark.getBoundingClientRect();
    tip.textContent = words;
    tip.hidden = false;
    const left = Math.min(Math.max(8, box.left + box.width / 2 + 14), innerWidth - tip.offsetWidth - 8);
    const below = box.bottom + 6;
    tip.style.left = left + "px";
    tip.style.top = (below + tip.offsetHeight > innerHeight ? Math.max(8, box.top - tip.offsetHeight - 6) : below) + "px";
  };
  const hide = () => { tip.hidden = true; };
  mark.addEventListener("pointerenter", show);
  mark.addEventListener("pointerleave", hide);
  mark.addEventListener("focus", show);
  mark.addEventListener("blur", hide);
}
addEventListener("scroll", () => { tip.hidden = true; }, { passive: true });
// The slider between two pictures.
for (const slider of document.querySelectorAll(".compare input")) {
  slider.addEventListener("input", () => slider.parentElement.style.setProperty("--p", slider.value + "%"));
}
