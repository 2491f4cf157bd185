/** Refusals about incidents, orders, alarms and pins, by their codes, in German. */
import type { Part } from "../catalogue";

export const refusal_incident: Part<"refusal_incident"> = {
  "alarm-acknowledged":
    "{by} hat ihn schon quittiert",
  "alarm-not-open":
    "Es gibt keinen offenen Alarm {alarm}",
  "alarm-of-station":
    "Dieser Alarm betrifft die Station selbst; er hat keine Werte eines Geräts.",
  "alarm-raised-anew":
    "Der Alarm wurde erneut ausgelöst, seit Sie ihn gesehen haben; sehen Sie noch einmal hin: {alarm}",
  "alarm-unknown":
    "Diesen Alarm gibt es nicht.",
  "all-clear-names-none":
    "„Räumung aufgehoben“ beendet eine Räumung: Nennen Sie diese",
  "anchor-no-place":
    "{lat_deg}, {lon_deg} ist keine geografische Breite und Länge",
  "beacon-gone":
    "Es gibt keine Bake {beacon}; sie wurde vielleicht schon entfernt",
  "beacon-reach":
    "Die Reichweite einer Bake ist eine Zahl in Metern, 0 oder mehr",
  "beacon-unknown":
    "Diese Bake gibt es nicht.",
  "check-in-addressee":
    "Nennen Sie eines davon: ein Gerät, einen Trupp oder ein Geschoss mit Personen, alle",
  "check-in-id-taken":
    "Eine Bestätigung braucht eine eigene Kennung, nicht {check_in}",
  "check-in-nobody":
    "Von {recipients, select, everyone {allen} other {{recipients}}} ist niemand in einem offenen Einsatz im Dienst",
  "command-acknowledged":
    "{by} hat ihn schon bestätigt",
  "command-addressee":
    "Nennen Sie eines davon: ein Gerät, einen Trupp oder ein Geschoss mit Personen, alle",
  "command-id-taken":
    "Ein Befehl braucht eine eigene Kennung, nicht {command}",
  "command-incident-closed":
    "Der Einsatz dazu ist abgeschlossen: Was darin eingetragen wurde, bleibt, wie es ist",
  "command-kind-unknown":
    "Diese Art von Befehl kennt die Station nicht",
  "command-lasts":
    "Ein Befehl dauert höchstens einen Tag, nicht {lasts_s}",
  "command-not-by-radio":
    "Ein solcher Befehl betrifft nur das Gerät: Er wird nicht über Funk beantwortet",
  "command-not-to-unit":
    "Es gibt keinen Befehl {command} an {unit}",
  "command-of-station":
    "Das sendet die Station von selbst; es kann nicht befohlen werden",
  "command-over":
    "Der Befehl ist vorbei: Was dazu eingetragen wurde, bleibt, wie es ist",
  "command-recipients-none":
    "Kein registriertes Gerät kann das empfangen: {recipients, select, everyone {alle} other {{recipients}}}",
  "command-unknown":
    "Diesen Befehl gibt es nicht.",
  "commands-too-many":
    "{most} Befehle sind offen; warten Sie, bis einige beantwortet sind",
  "dispatch-not-listed":
    "Es gibt keinen Einsatzauftrag {number}.",
  "dispatch-opened":
    "Aus dem Einsatzauftrag {number} wurde der Einsatz „{incident}“ schon eröffnet",
  "dispatch-unknown":
    "Es gibt keinen Einsatzauftrag {number}, aus dem kein Einsatz eröffnet wurde",
  "evacuation-ordered-anew":
    "Alle davon wurden seither erneut hinausbefohlen: Beenden Sie jene Räumung",
  "evacuation-over":
    "Diese Räumung ist schon beendet",
  "evacuation-unknown":
    "Es gibt keine Räumung {command}, die zu beenden wäre",
  "floor-not-on-plan":
    "Der Plan hat kein Geschoss {floor}; er hat: {known}",
  "floor-out-of-range":
    "Kein Gebäude hat ein Geschoss {floor}; von {lowest} bis {highest} ist sinnvoll",
  "guides-too-many":
    "{most} Retter werden geführt; beenden Sie zuerst einige Führungen.",
  "heading-unfit":
    "Eine Richtung braucht einen Winkel und eine Unsicherheit von mehr als 0",
  "incident-gone":
    "Ein Einsatz {incident} ist weder offen noch der zuletzt abgeschlossene",
  "incident-id-taken":
    "Ein Einsatz braucht eine eigene Kennung, nicht {incident}",
  "incident-not-among-open":
    "Es gibt keinen offenen Einsatz {incident}.",
  "incident-unknown":
    "Es gibt keinen Einsatz {incident}.",
  "incident-not-named":
    "Mehrere Einsätze sind offen; nennen Sie einen in incident_id: {incidents}.",
  "incident-not-open":
    "Es gibt keinen offenen Einsatz {incident}",
  "incident-not-stored-yet":
    "Der Einsatz wurde eröffnet, aber die Datenbank hat ihn noch nicht übernommen.",
  "incident-open-meanwhile":
    "Ein Einsatz ist offen; schließen Sie ihn zuerst ab",
  "incident-still-open":
    "Der Einsatz „{incident}“ ist offen; schließen Sie ihn zuerst ab",
  "incident-without-id":
    "Ohne Kennung ist kein Einsatz offen",
  "incidents-several":
    "Mehrere Einsätze sind offen ({incidents}); nennen Sie einen davon",
  "locate-over":
    "Kein Gerät macht sich durch diesen Befehl noch bemerkbar",
  "locate-unknown":
    "Es gibt kein LOCATE {command}, das zu beenden wäre",
  "message-empty":
    "Eine Nachricht braucht einen Text",
  "no-open-incident":
    "Es ist kein Einsatz offen",
  "not-on-duty":
    "{name} ist nicht in einem offenen Einsatz im Dienst",
  "nothing-to-undo":
    "Unter dieser Kennung gibt es keine Bestätigung über Funk, die zurückzunehmen wäre",
  "number-not-finite":
    "Eine Koordinate oder ein Winkel ist keine endliche Zahl",
  "order-end-unknown":
    "Ein Befehl endet mit ALL_CLEAR oder END_ORDER",
  "order-not-repeatable":
    "Nur ein Befehl, der eine Antwort verlangt, kann erneut gesendet werden",
  "order-over":
    "Dieser Befehl ist vorbei: Geben Sie einen neuen",
  "order-unknown":
    "Es gibt keinen Befehl {command}, der erneut zu senden wäre",
  "pin-gone":
    "Es gibt keinen Pin {pin}; er wurde vielleicht schon entfernt",
  "pin-incidents-differ":
    "Diese Geräte sind in verschiedenen Einsätzen: Sie haben keinen gemeinsamen Ort",
  "pin-meets-itself":
    "Ein Gerät kann sich nicht selbst treffen: Nennen Sie zwei Geräte",
  "pin-no-unit":
    "Kein Gerät zu setzen: Nennen Sie mindestens eines",
  "pin-of-another-kind":
    "Dieser Pin ist von anderer Art ({kind}); entfernen Sie ihn, und setzen Sie einen anderen.",
  "pin-unknown":
    "Diesen Pin gibt es nicht.",
  "pins-too-many":
    "Es ist Platz für {most} Pins, nicht für {wanted}; entfernen Sie zuerst einige",
  "place-no-numbers":
    "Der Ort ist kein Zahlenpaar",
  "place-too-far":
    "Der Ort ist {away_m} vom Gebäude des Plans entfernt; höchstens {most_m} sind sinnvoll",
  "position-rate-not-finite":
    "Diese Positionsrate ist keine endliche Zahl",
  "rescuer-is-member":
    "Der Retter ist das Mitglied selbst: Nennen Sie einen anderen Retter.",
  "rescuer-not-guided":
    "Dieser Retter wird nicht geführt.",
  "start-uncertainty-negative":
    "Ein Start braucht Unsicherheiten, die nicht negativ sind",
  "uncertainty-unfit":
    "Eine Unsicherheit von {std_m} lässt sich nicht gewichten; geben Sie an, um wie viele Meter der Ort falsch sein kann, mehr als 0",
  "unit-unknown":
    "Dieses Gerät gibt es nicht.",
  "unit-without-position":
    "{unit} hat keine Position: Es wurde keine empfangen.",
  "incident-not-closed":
    "Der Einsatz ist nicht abgeschlossen: {alarms, plural, =0 {kein offener Alarm} one {# offener Alarm} other {# offene Alarme}}, {inside, plural, =0 {niemand} one {# Person} other {# Personen}} im Innern.",
  "rests-already":
    "{name} macht schon Pause",
  "works-already":
    "{name} ist schon im Einsatz",
  "incident-time-unfit":
    "Die Zeit bis {what, select, rest {zur nächsten Pause} other {zum nächsten PAR}} liegt zwischen {shortest_s} und {longest_s}",
  "order-answered":
    "{unit, select, everybody {Alle haben ihn} other {{unit} hat ihn}} quittiert oder nie erhalten",
  "pin-in-future":
    "Die Zeit des Pins liegt {ahead_s} in der Zukunft; geben Sie an, wann es war",
  "pin-before-path":
    "Die Zeit des Pins liegt {early_s} vor dem Beginn des Wegs von {unit}; da gibt es nichts festzulegen",
  "fuser-unknown":
    "Diese Version von Muster hat kein Ortungsverfahren „{fuser}“",
  "report-no-number":
    "Die Meldung hat keine Nummer: Geben Sie {part} an, 1 bis {longest, number} Zeichen; nichts wurde übernommen.",
  "report-json-unreadable": "Der Inhalt ist kein lesbares JSON: {error}.",
  "report-no-object": "Der Inhalt ist kein JSON-Objekt: Senden Sie ein EIDO oder ein Objekt mit einer Nummer.",
  "alert-no-xml": "Der Inhalt ist kein zulässiges XML: {error}.",
  "alert-no-cap": "Der Inhalt ist keine CAP-Warnung: Das oberste Element ist „{root}“.",
  "alert-no-id": "Die Warnung hat kein {part}; nichts wurde übernommen.",
  "alerts-not-taken": "Diese Station nimmt keine Warnungen an: Sie gibt nur wieder.",
  "media-type-other": "Senden Sie es als eines von {types} (Kopfzeile Content-Type).",
};
