import type { Part } from "../catalogue";

export const replay: Part<"replay"> = {
  title: "Wiedergabe",
  word: "WIEDERGABE",
  what: "{incident}, {time} {zone}. Aufzeichnung, nicht live.",
  accuracy: "Genauigkeitsbericht",
  first: "Zurück zur ersten Wiedergabe",
  live: "Zurück zu live",
  flaws: "Nicht alles ist wie damals: {count, number}",
  gap: "Keine Aufzeichnung von {from} bis {until}",
  gap_shown: "Gezeigt sind die letzten Positionen davor.",
  no_alarms: "Jetzt live: keine offenen Alarme",
  alarms: "{count, plural, one {Jetzt live: # offener Alarm} other {Jetzt live: # offene Alarme}}",
  station: "Basisstation: {problem}",
};

export const transport: Part<"transport"> = {
  alarm_before: "Voriger Alarm",
  alarm: "Alarm",
  back: "Zurück {time}",
  pause: "Pause",
  play: "Abspielen",
  on: "Vor {time}",
  next_alarm: "Nächster Alarm",
  going: "Gehe zu {time} …",
  progress: "{at} von {all}",
  go_to: "Zu einem Alarm gehen",
  no_alarms: "Keine Alarme",
  alarms: "{count, plural, one {# Alarm …} other {# Alarme …}}",
  speed: "Geschwindigkeit",
  time: "Zeit des Einsatzes",
};

export const timeline: Part<"timeline"> = {
  title: "Zeitverlauf von {name}",
  span: "{from} bis {until}, {date}.",
  hint: "Grau: kein Funkkontakt. Zum Vergrößern über eine Linie ziehen.",
  hint_replay: "Auf eine Linie drücken, um in der Wiedergabe dorthin zu gehen.",
  reading: "Die Basisstation liest ihr Protokoll …",
  time: "Gezeigte Zeit",
  earlier: "Früher",
  later: "Später",
  zoom_in: "Vergrößern",
  zoom_out: "Verkleinern",
  all: "Alles",
  until_now: "Bis jetzt",
  values_at: "Werte um {time}",
  replay: "Ab hier wiedergeben",
  strip: "{title}: {values}",
  no_values: "keine Werte",
  unknown: "nicht bekannt",
  temperature_degc: "Temperatur",
  height_m: "Höhe",
  floor: "Geschoss",
  activity: "Tätigkeit",
  battery: "Akku",
  position_error_m: "Angegebener Positionsfehler (DRMS)",
  silence_s: "Verbindung: Zeit ohne Meldung",
  range: "{low} bis {high}",
};

export const crossing: Part<"crossing"> = {
  sentence: "Um {time} war {series} {value}, jenseits der Schwelle „{threshold}“ ({limit}).",
  motionless_s: "Zeit ohne Bewegung",
  temperature_degc: "Temperatur",
  battery: "Akku",
  threshold: "{name} {value}",
};
