import type { Part } from "../catalogue";

export const anchor: Part<"anchor"> = {
  title: "Lage des Plans",
  align: "Nach zwei Punkten ausrichten",
  first_point: "Erster Punkt",
  second_point: "Zweiter Punkt",
  point: "{point}: {where}",
  click: "auf den Plan klicken",
  latitude: "Breite, °",
  hint: "Nehmen Sie zwei weit entfernte Ecken. Eine Karte oder ein GPS-Empfänger sagt, wo sie sind.",
  hint_map:
    "Nehmen Sie zwei weit entfernte Ecken. Klicken Sie dieselben zwei in derselben Reihenfolge auf dem Plan und auf der Karte an.",
  save: "Lage speichern",
  too_near:
    "Die Punkte sind auf dem Plan {plan} und auf der Erde {earth} voneinander entfernt: Nehmen Sie zwei weiter entfernte.",
  wrong_point:
    "Die Punkte sind auf dem Plan {plan} und auf der Erde {earth} voneinander entfernt: Einer ist ein anderer Punkt, oder der Maßstab des Plans ist falsch.",
  moves: "wer durch Satelliten geortet ist, rückt auf dem Plan um {distance}",
  turns: "wer durch Satelliten geortet ist, wird auf dem Plan um {angle} gedreht",
  moves_and_turns:
    "wer durch Satelliten geortet ist, rückt auf dem Plan um {distance} und wird um {angle} gedreht",
  height: "die Höhe ändert sich um {distance}",
  change: "Der Plan hat eine Lage: {place}. Mit der neuen: {change}.",
  change_two: "Der Plan hat eine Lage: {place}. Mit der neuen: {change}, und {other}.",
  place: "{latitude}, {longitude}, sein Norden in Richtung {heading}",
};

export const base_map: Part<"base_map"> = {
  done: "Die Grundkarte ist gesetzt.",
  none: "Es gibt keine.",
  some: "Es gibt eine.",
  not_world_file: "Eine World-Datei hat sechs Zahlen, eine je Zeile.",
  picture: "Bild (PNG, JPEG oder WebP)",
  world_file: "World-Datei (.pgw, .jgw, .tfw oder .wld)",
  epsg: "EPSG-Nummer (leer: Grad oder Webkarte)",
  set: "Grundkarte setzen",
  remove: "Grundkarte entfernen",
  remove_question: "Die Karte für alle entfernen?",
};

export const beacon: Part<"beacon"> = {
  title: "Bake",
  new: "Hier hängt eine Bake",
  number: "Ihre Nummer",
  not_passed: "Noch kein Gerät ist an ihr vorbeigekommen.",
  passed: "Ein Gerät kam vor {age} an ihr vorbei.",
  reach: "Bemerkt ab, {unit}",
  place: "Bake setzen",
  save: "Bake speichern",
  remove: "Bake entfernen",
  remove_question: "Niemand, der an ihr vorbeikommt, wird noch durch sie geortet.",
};

export const plan: Part<"plan"> = {
  contents:
    "{name}: {floors, plural, one {# Geschoss} other {# Geschosse}}, {rooms, plural, one {# Raum} other {# Räume}}, {shapes, plural, one {# Form} other {# Formen}}",
  unnamed: "Plan ohne Namen",
  in_room: "in {room}",
  near_room: "bei {room}",
  feature: "Element {number} des Plans",
  floor_picture: "Das Bild dieses Geschosses",
  unit: "{unit} auf dem Plan",
  colours: "Die Farben des Plans",
  scale: "Der Maßstab des Plans",
  building: "Das Gebäude",
  pins: "Die Pins auf dem Plan",
  trails: "Die Spuren auf dem Plan",
  way: "Der Weg auf dem Plan",
  others: "Andere Kräfte auf dem Plan",
  paper: "Blatt: Pfeiltasten bewegen das Kreuz, Enter setzt einen Punkt",
  outside_view: "In Gefahr, außerhalb der Ansicht",
  show: "{name} zeigen",
  show_outside: "{name} zeigen, außerhalb der Ansicht in Richtung {direction}",
  floor_shown: "Gezeigtes Geschoss",
  all_floors: "Alle",
  floor_label: "Geschoss {floor},",
  floors_label: "Geschosse: {floor},",
  in_danger_of: "in Gefahr, von",
  people: "{count, plural, one {Person} other {Personen}}",
};

export const compass: Part<"compass"> = {
  n: "Norden",
  ne: "Nordosten",
  e: "Osten",
  se: "Südosten",
  s: "Süden",
  sw: "Südwesten",
  w: "Westen",
  nw: "Nordwesten",
};

export const trail: Part<"trail"> = {
  fused: "Live-Spur",
  raw: "Nur Koppelnavigation",
  smoothed: "Nachbearbeitet",
  title: "Spuren",
  loading: "wird berechnet …",
  hint_all: "Die letzten fünf Minuten. Wählen Sie eine Person, um alle ihre Spuren zu vergleichen.",
  hint_chosen: "Die der gewählten Person von Anfang an, wenn mehr als die erste gezeichnet ist.",
};

export const mark: Part<"mark"> = {
  pin: "Pin: {name}, {when}",
  start: "Start",
  emergency: "NOTFALL {name}",
  other_team: "{name} ({source})",
};
