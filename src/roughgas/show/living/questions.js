// What the page asks, and what it then shows.

const QUESTIONS = [
  { asked: "Nearly smooth disks (β = −0.8) with r = 0.8 start without spin, and cool. Where does R settle?",
    shows: ["cooling", 0.8, -0.8], answers: ["near 0: smooth disks hardly turn", "at ½: equal shares", "near 1: spin takes over"], right: 2,
    why: "Each contact takes a fifth of the normal speed, but hardly touches spin. So translation cools faster than rotation, and what energy is left is nearly all spin. Now set r to 0.99." },
  { asked: "A floor shakes perfectly rough disks (β = 1, r = 0.9). It only pushes, and never turns them. Where does R settle?",
    shows: ["vibrated", 0.9, 1], answers: ["near 0: only translation is driven", "near ½", "near 1"], right: 1,
    why: "At β = 1 a contact loses nothing by roughness: it hands energy to and fro until the shares are equal, though all of it comes in as translation. Now lower β." },
  { asked: "The shaken disks have β = 0. Lower r from 0.95 to 0.7, so that they lose much more. What does R do?",
    shows: ["vibrated", 0.95, 0], answers: ["it falls by half", "it hardly changes", "it doubles"], right: 1,
    why: "Lun's formula for driven gases has no r in it. (R measured over time creeps up by some per cent: fast disks collide more often.) In a gas that cools, r matters most: try it." },
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
  const { shows, right, why, answers } = QUESTIONS[asked];
  set(...shows);
  speed = Number(at("speed").value = "4");
  playing = true;
  go();
  at("verdict").textContent = `${answer === right ? "Yes." : `No: ${answers[right]}.`} Watch R. ${why}`;
}
