// Questions of the page, and the gases that answer them.

const QUESTIONS = [
  { asked: "Nearly smooth disks (β = −0.8) with r = 0.8 start without spin, and cool. Where does R settle?",
    shows: ["cooling", { r: 0.8, beta: -0.8 }], answers: ["near 0: smooth disks hardly turn", "at ½: equal shares", "near 1: spin takes over"], right: 2,
    why: "Each contact takes a fifth of the normal velocity, but hardly touches spin. So translation cools faster than rotation, and the energy that is left is nearly all spin: R is 0.975. Now set r to 0.99: R is 0.05." },
  { asked: "A floor shakes perfectly rough disks (β = 1, r = 0.9). It only pushes, and never turns them. Where does R settle?",
    shows: ["vibrated", { r: 0.9, beta: 1 }], answers: ["near 0: only translation is driven", "near ½", "near 1"], right: 1,
    why: "At β = 1 contacts lose no energy of sliding: they pass it to spin and back until the shares are equal, though all of it comes in as translation: R is 0.50. Now lower β." },
  { asked: "The shaken disks have β = 0. Lower r from 0.95 to 0.7, so that they lose much more. What does R, averaged over time, do?",
    shows: ["vibrated", { r: 0.95, beta: 0 }, { r: 0.7, beta: 0 }], answers: ["it falls by half", "it rises by about 30 %", "it triples"], right: 1,
    why: "R rises from 0.215 to 0.277. Lun's formula, 0.200, has no r in it, but it is one of averages over collisions, and these are 0.201 and 0.203. Fast pairs collide more often but do not spin faster." },
  { asked: "Shaken disks with β = 0 and r = 0.9: uniform disks (q = 0.5) beside rings (q = 1). Which have the larger R?",
    shows: ["vibrated", { r: 0.9, beta: 0 }, { r: 0.9, beta: 0, q: 1 }], answers: ["the uniform disks: they turn easily", "both have the same", "the rings"], right: 2,
    why: "R is 0.225 for uniform disks and 0.30 for rings. What is easy to turn is as easily stopped by the next contact, and holds little energy." },
];
let asked = 0;

function ask() {
  const { asked: text, answers } = QUESTIONS[asked];
  at("asked").textContent = text;
  at("verdict").textContent = "";
  at("answers").replaceChildren(...answers.map((answer, i) => {
    const button = Object.assign(document.createElement("button"), { type: "button", textContent: answer });
    button.addEventListener("click", () => judge(i));
    return button;
  }));
}

function judge(answer) {
  const { shows: [scene, ...materials], right, why, answers } = QUESTIONS[asked];
  show(scene, materials);
  at("speed").value = "4";
  playing = true;
  go();
  at("verdict").textContent = `${answer === right ? "Yes." : `No: ${answers[right]}.`} Watch R. ${why}`;
}
