/** Problems of the station and of a department, by the codes of their sentences, in German. */
import type { Part } from "../catalogue";

export const problem: Part<"problem"> = {
  "acted-apart":
    "Während die Stationen getrennt waren, wurde an {station} gehandelt ({count, number}-mal), und das gilt hier nicht: Das Protokoll nennt es; was noch wichtig ist, noch einmal tun",
  "archive-away":
    "Abgeschlossene Einsätze werden seit {minutes} nicht archiviert, {waiting, number} warten: {reason}",
  "bus-plain":
    "Der Bus ist unverschlüsseltes TCP: Jeder Rechner, der ihn erreicht, kann sich als jedes Gerät ausgeben",
  "certificate-expired":
    "Das Zertifikat {holder, select, console {der Konsole} this_station {dieser Station} first_station {der ersten Station} station {der Station {name}} operator {des Bedieners {name}} tracker {des Tracking-Agenten von {name}} other {des Geräts {name}}} ist am {ends_utc_s} abgelaufen: {command}",
  "certificate-expires":
    "Das Zertifikat {holder, select, console {der Konsole} this_station {dieser Station} first_station {der ersten Station} station {der Station {name}} operator {des Bedieners {name}} tracker {des Tracking-Agenten von {name}} other {des Geräts {name}}} läuft {days, plural, =0 {in weniger als einem Tag} one {in # Tag} other {in # Tagen}} ab: {command}",
  "certificate-renewed":
    "Das Zertifikat dieser Station wurde erneuert. Die Station startet damit neu, was einige Sekunden dauert, wenn der Einsatz abgeschlossen ist, oder eine Stunde bevor das jetzige endet ({ends_utc_s})",
  "checkpoint-refused":
    "Der aktuelle Stand lässt sich nicht speichern ({error}): Platz auf dem Datenträger schaffen",
  "clock-ahead":
    "Die Uhr dieses Rechners geht der aufgezeichneten Zeit {off_s} vor; diese springt an einer Reservestation oder in einem offenen Einsatz nicht: Die Uhr stellen oder den Einsatz abschließen",
  "clock-before-certificates":
    "Die Uhr dieses Rechners steht auf {now_utc_s}, und es gibt Zertifikate, die erst am {begins_utc_s} beginnen: die Uhr stellen; vorher kommt mit ihnen keine Verbindung zustande",
  "clock-behind":
    "Die Uhr dieses Rechners geht gegenüber der letzten Aufzeichnung {off_s} nach: die Uhr stellen. Bis dahin laufen die Zeiten von dort weiter",
  "connections-refused":
    "{count, number} Verbindungen zum Bus wurden in der letzten Minute abgewiesen ({total, number} seit dem Start des Routers), davon {of_network, number} von {network}, die meisten wegen: {reason, select, silent {keine rechtzeitige Begrüßung} ended {Ende vor einer Begrüßung} not_tls {kein TLS oder kein Zertifikat der Zertifizierungsstelle dieser Station} not_enrolled {ein Zertifikat, das gesperrt ist oder nicht auf der Liste steht} banned {ein Inhaber, der vorübergehend ausgesperrt ist} too_often {mehr Verbindungen eines Inhabers als zulässig} other {mehr gleichzeitige Verbindungen als zulässig}}. Geräte werden trotzdem verbunden; siehe docs/howto/when-attacked.md",
  "console-name-not-certified":
    "Das Zertifikat der Konsole gilt nicht für {name}, sodass Browser davor warnen: mit „muster pki renew-station --host {name}“ und --host für jeden weiteren Namen und jede Adresse ein neues erstellen",
  "console-not-announced":
    "Browser finden diese Konsole nicht als {name}: {error}",
  "database-authority-unread":
    "das Zertifikat der Stelle, die das des Datenbankservers ausstellte, ist nicht lesbar ({reason}): es als PEM in sslrootcert der Adresse angeben",
  "database-certificate-name":
    "das Zertifikat des Datenbankservers gilt für einen anderen Namen ({reason}): den Namen in die Adresse schreiben, für den es gilt, oder dem Server eines für seinen Namen geben",
  "database-certificate-refused":
    "das Zertifikat des Datenbankservers wird nicht angenommen ({reason}): Es ist abgelaufen, noch nicht gültig, oder von einer anderen Stelle als der in sslrootcert der Adresse; seine Daten (openssl x509 -noout -dates -issuer) und die Uhr dieses Rechners prüfen",
  "database-unencrypted":
    "der Datenbankserver hat kein Zertifikat ({reason}): ssl am Server einschalten",
  "database-unreachable": "der Datenbankserver antwortet nicht ({reason})",
  "database-away":
    "{reason}; Personen werden wie bisher gezeigt und geführt, und die Aufzeichnung hat alles; Anmeldungen, frühere Einsätze, Benutzer und Personen warten auf die Datenbank; prüfen, ob der Server läuft und erreichbar ist",
  "database-catching-up":
    "Was entschieden wurde, während die Datenbank nicht antwortete, wird aus der Aufzeichnung nachgetragen",
  "database-changes-dropped":
    "{count, number} Änderungen kamen nicht in die Datenbank ({reason}); die Aufzeichnung hat sie: „muster base rebuild“ ausführen, sobald die Ursache behoben ist",
  "database-changes-refused":
    "{count, number} Änderungen aus der Zeit, in der der Datenträger nichts annahm, sind nicht in der Datenbank, da dort inzwischen andere gemacht wurden: Benutzer und Personen durchsehen",
  "database-damaged":
    "Die Datenbank ist beschädigt: {damage}",
  "database-gone":
    "Die Datenbank fehlte oder war leer und wurde aus der Aufzeichnung neu erstellt; {loss}",
  "database-in-memory":
    "Die Datenbank wird im Arbeitsspeicher gehalten, da ihr Datenträger nichts annimmt: Änderungen werden geschrieben, sobald er es tut, und sind verloren, wenn die Station vorher endet; {reason}",
  "database-in-memory-without-trails":
    "Die Datenbank wird im Arbeitsspeicher gehalten, da ihr Datenträger nichts annimmt: Änderungen werden geschrieben, sobald er es tut, und sind verloren, wenn die Station vorher endet; Wege früherer Einsätze können nicht gezeigt werden; {reason}",
  "database-made-again":
    "Die Datenbank war beschädigt ({damage}) und wurde aus der Aufzeichnung neu erstellt; {loss}. {file}; den Datenträger prüfen",
  "department-away":
    "Die Dienststelle ({addresses}) ist seit {away_s} nicht erreichbar: {reason}. Was ihr fehlt, wird aufbewahrt und später gesendet",
  "department-events-missing":
    "{count, number} Ereignisse von {station} fehlen hier: Die Datenbank dieser Dienststelle ist älter als das, was sie bestätigt hat. Die Aufzeichnung der Station hat sie",
  "department-reports-unreadable":
    "{count, number} Meldungen von Stationen waren nicht lesbar: Ist dieses Muster älter?",
  "department-same-station":
    "Mehrere Rechner melden sich als {station}: {hosts}. Die Personen aller werden gezeigt; jeder Station eine eigene Anmeldung geben und diese sperren",
  "department-station-clock":
    "Die Uhr von {station} geht gegenüber der Dienststelle {off_s} {side, select, ahead {vor} other {nach}}: Zeiten werden nach der Uhr der Dienststelle gezeigt; die falsche stellen",
  "erased-in-archive":
    "{count, plural, one {# Kopie} other {# Kopien}} im Archiv {archive} vielleicht mit gelöschten Personen; neue werden angelegt",
  "erased-in-archive-away":
    "{count, plural, one {# Kopie} other {# Kopien}} im Archiv {archive} vielleicht mit gelöschten Personen; neue werden später angelegt: {reason}",
  "erased-in-other-archive":
    "{count, plural, one {# Kopie} other {# Kopien}} im Archiv {archive} vielleicht mit gelöschten Personen, und die Station kopiert nicht dorthin: muster base archive copy {archive} ausführen",
  "erasure-under-way":
    "Die Aufzeichnung wird neu geschrieben, um {kind, select, person {eine Person} incident {einen Einsatz} other {{kind}}} zu löschen ({share_fraction}), wie von {by} gewünscht",
  "erasure-waits":
    "Die Aufzeichnung wird neu geschrieben, um {kind, select, person {eine Person} incident {einen Einsatz} other {{kind}}} zu löschen ({share_fraction}), wie von {by} gewünscht: {reason}",
  "journal-floods":
    "Das Journal von {unit_id} bringt mehr, als ein Gerät in Stunden sendet ({most, number} Meldungen, {most_mb} oder {most_alerts, number} Alarme): Der Rest wird langsam geholt. War es nicht lange außer Reichweite, es ausschalten oder sperren: muster pki revoke {unit_id}",
  "log-damaged":
    "Ein Teil der Aufzeichnung ist nicht mehr lesbar ({files}): den Datenträger prüfen. {remedy, select, other_station {Was fehlt, wird von der anderen Station geholt, sobald diese erreichbar ist} other {Meldungen der Geräte werden noch einmal aus deren Journalen geholt; für den Rest die Datei aus einer Sicherung zurückspielen}}",
  "log-disk-hangs":
    "{folder} kann nicht beschrieben werden: Der Datenträger antwortet nicht; ihn prüfen",
  "log-files-gone":
    "Dateien der Aufzeichnung fehlen, nach ihren Nummern {segments}: den Datenträger prüfen, sie aus einer Sicherung zurückspielen und die Station neu starten",
  "log-foreign-files":
    "Dateien im Ordner der Aufzeichnung gehören nicht zu ihr und werden ausgelassen ({files}): klären, woher sie kommen, und sie entfernen",
  "log-little-room":
    "nur {free_mb} sind für die Aufzeichnung in {folder} frei: Platz auf dem Datenträger schaffen",
  "log-part-lost":
    "Ein Teil der Aufzeichnung ist verloren: {lost}: den Datenträger prüfen. {remedy, select, other_station {Was fehlt, wird von der anderen Station geholt, sobald diese erreichbar ist} other {Meldungen der Geräte werden noch einmal aus deren Journalen geholt; für den Rest die Datei aus einer Sicherung zurückspielen}}",
  "log-records-lost":
    "die Aufzeichnung kann nicht nach {folder} geschrieben werden ({error}): {waiting_mb} warten im Arbeitsspeicher, {lost, number} Einträge sind verloren; Platz schaffen oder den Datenträger ersetzen",
  "log-records-missing":
    "der Datenträger war zu langsam: {lost, number} Einträge fehlen in der Aufzeichnung, von {from_utc_s} bis {until_utc_s}",
  "log-waits":
    "die Aufzeichnung kann nicht nach {folder} geschrieben werden ({error}): {waiting_mb} warten im Arbeitsspeicher; Platz schaffen oder den Datenträger ersetzen",
  "messages-left-out":
    "Meldungen kommen schneller, als dieser Rechner sie annehmen kann; {count, number} wurden ausgelassen und werden aus den Journalen der Geräte geholt",
  "messages-not-kept":
    "Meldungen, für die das Journal eines Geräts seit deren Start keinen Platz hatte: {counts}. Gingen sie auch auf der Verbindung verloren, fehlen sie: Platz auf dem Datenträger des Geräts schaffen oder ihn ersetzen",
  "messages-unreadable":
    "{count, number} Meldungen waren nicht lesbar; zuletzt {last}",
  "part-ended":
    "Ein Teil der Station endete durch einen Programmfehler ({name}): die Station im nächsten ruhigen Moment neu starten und den Fehler melden",
  "part-failed":
    "Ein Teil der Station ({part}) schlug fehl: {error}; bitte melden",
  "radio-not-recorded":
    "Funkkanal {name} wird nicht aufgezeichnet: {reason}",
  "recorder-stopped":
    "die Aufzeichnung hat angehalten, nichts wird aufgezeichnet ({error}): neu starten",
  "restart-storm":
    "Das Programm eines Geräts startet ungewöhnlich oft ({key}): ausgelassen",
  "router-away":
    "Der Router des Busses ist ausgefallen und wird neu gestartet; kein Gerät ist verbunden",
  "rule-failed":
    "Die Alarmregel „{rule}“ schlug für {unit_id} fehl und urteilte nicht: {error}",
  "secret-open":
    "{path} ist für andere lesbar oder änderbar, und das lässt sich nicht entziehen ({error}): dem Benutzer der Station mit Modus 0600 geben; {remedy, select, authority_key {damit lässt sich jedes Gerät anmelden: Wenn Fremde diesen Rechner benutzen, eine neue Zertifizierungsstelle anlegen und alle Geräte neu anmelden} station_key {damit kann sich ein Rechner als diese Station ausgeben: Wenn Fremde diesen benutzen, eine neue Zertifizierungsstelle anlegen und alle Geräte neu anmelden} first_login {dem Administrator ein anderes Passwort geben} database_password {wenn Fremde diesen Rechner benutzen, dem Benutzer der Datenbank ein anderes Passwort geben} database {wenn Fremde diesen Rechner benutzen, jedem Benutzer ein anderes Passwort geben} other {wenn Fremde diesen Rechner benutzen, einen anderen Schlüssel erzeugen}}",
  "secret-was-open":
    "{path} war für andere lesbar oder änderbar (Modus {mode}) und wurde für sie gesperrt; {remedy, select, authority_key {damit lässt sich jedes Gerät anmelden: Wenn Fremde diesen Rechner benutzen, eine neue Zertifizierungsstelle anlegen und alle Geräte neu anmelden} station_key {damit kann sich ein Rechner als diese Station ausgeben: Wenn Fremde diesen benutzen, eine neue Zertifizierungsstelle anlegen und alle Geräte neu anmelden} first_login {dem Administrator ein anderes Passwort geben} database_password {wenn Fremde diesen Rechner benutzen, dem Benutzer der Datenbank ein anderes Passwort geben} database {wenn Fremde diesen Rechner benutzen, jedem Benutzer ein anderes Passwort geben} other {wenn Fremde diesen Rechner benutzen, einen anderen Schlüssel erzeugen}}",
  "sender-floods":
    "{sender_id} sendet mehr, als ein Gerät es tut (über {most, number} Meldungen oder {most_mb} je Sekunde): Der Überschuss wird verworfen. Es ausschalten oder sperren: muster pki revoke {sender_id}",
  "sender-forged":
    "Ein Sender auf dem Bus gibt sich als die Station aus ({key}): abgewiesen",
  "sender-shut-out":
    "{sender_id} ({reason}): für {minutes} ausgesperrt, da es andere aufhält; sein Träger ist so lange nicht erreichbar: über Sprechfunk fragen. Das Gerät tauschen oder sperren: muster pki revoke {sender_id}",
  "standby-behind":
    "Die Reservestation ist im Rückstand: Was jetzt geschieht, hat nur diese Station",
  "standby-cut-off":
    "Keine Meldung von {station} oder einem Gerät kommt an: Diese Station ist wahrscheinlich abgeschnitten. Sie übernimmt, sobald sie ein Gerät empfängt, oder von Hand",
  "standby-disk":
    "Der Datenträger dieser Reservestation nimmt die Aufzeichnung nicht an: Platz schaffen oder ihn ersetzen; was fehlt, wird dann geholt",
  "standby-empty":
    "Keine aktive Station ist erreichbar, und diese neue Reservestation hat noch nichts: Sie wartet",
  "standby-fetching":
    "Diese Reservestation hat noch nicht alles von der aktiven Station",
  "standby-lacks-log":
    "{station} ist nicht erreichbar, und diese Reservestation hat nicht alles von ihr: Sie wartet {wait_s} auf deren Rückkehr und übernimmt dann, oder von Hand",
  "standby-none":
    "Es gibt keine Reservestation: Was jetzt geschieht, hat nur diese Station",
  "standby-other-version":
    "Station {station} hat eine andere Version: Die beiden können sich nicht vertreten, bis beide aktualisiert sind",
  "standby-same-name":
    "Zwei Stationen heißen {station}: jeder unter [standby] einen eigenen Namen geben",
  "standby-takes-over":
    "Keine aktive Station ist erreichbar: Diese übernimmt in einigen Sekunden",
  "state-stale":
    "Was der Datenträger von der Aufzeichnung verloren hatte, ist wieder da, und das Lagebild dieser Station entstand ohne es. Es wird neu erstellt, sobald die andere Station Schritt hält und kein Einsatz offen ist; um es jetzt zu haben, die andere übernehmen lassen",
  "station-not-announced":
    "Die Station ist in ihrem Netz nicht angekündigt: {error}",
  "station-not-certified":
    "Geräte finden diese Station nicht unter {addresses}, da ihr Zertifikat dafür nicht gilt: mit „muster pki renew-station“ und --host für jede Adresse ein neues erstellen",
  "tak-away":
    "Die TAK-Verbindung „{name}“ ({url}) ist seit {away_s} ausgefallen: {reason}",
  "unregistered-messages":
    "{count, number} Meldungen von mehr nicht registrierten Geräten, als gezeigt werden",
};
