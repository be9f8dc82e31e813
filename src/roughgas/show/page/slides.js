"use strict";
const slides = [...document.querySelectorAll("section")];
const slider = document.querySelector("input");

function show() {
  slides.forEach((slide, number) => { slide.hidden = number !== Number(slider.value); });
  document.querySelector("output").value = slides[slider.value].querySelector("h2").textContent;
}

slider.addEventListener("input", show);
show();
