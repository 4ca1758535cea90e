"use strict";
// A click on a picture shows it large beside another one of its section, with a border that moves between them.
const dialog = document.querySelector("dialog");
const stage = document.getElementById("stage");
const slider = dialog.querySelector("input");
const selects = [...dialog.querySelectorAll("select")];
let pictures = [];

function show() {
  selects.forEach((select, side) => { stage.children[side].src = pictures[select.selectedIndex].src; });
  stage.classList.toggle("small", pictures[0].naturalWidth < 640);
  stage.style.setProperty("--at", `${slider.value}%`);
}

document.addEventListener("click", event => {
  const section = event.target.closest("section");
  if (event.target.tagName !== "IMG" || !section) return;
  pictures = [...section.querySelectorAll("img")];
  selects.forEach((select, side) => {
    select.replaceChildren(...pictures.map(picture => new Option(picture.alt)));
    select.selectedIndex = side === 0 ? 0 : pictures.indexOf(event.target);
  });
  slider.value = 50;
  show();
  dialog.showModal();
});
dialog.addEventListener("input", show);
