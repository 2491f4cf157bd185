/** Faults that units report, by the codes of their sentences, in German. */
import type { Part } from "../catalogue";

export const unit_fault: Part<"unit_fault"> = {
  "accel-stuck": "der Beschleunigungssensor hat einen Wert wiederholt, während sich das Gerät drehte",
  "attribute-no-number": "{attribute} ist „{text}“, was keine Zahl ist",
  "batteries-several": "es gibt {count, number} Akkus; einen davon angeben: {there}",
  "batteries-there": "es gibt {there}",
  "battery-no-charge": "er zeigt keine Ladung zwischen 0 und 100 %",
  "battery-none": "dieser Rechner hat keinen Akku, den der Kernel zeigt",
  "battery-out": "es ist kein Akku eingelegt",
  "battery-unknown": "es gibt keinen Akku {name}; {listed}",
  "black-box-fails": "die Blackbox schlägt fehl: {error}",
  "black-box-hangs": "die Blackbox hängt: Der Datenträger antwortet seit {silent_s} nicht",
  "black-box-stopped": "die Blackbox hat angehalten",
  "button-ended": "das Programm an {path} hat sich beendet",
  "button-gone": "{path} gibt es nicht: nicht verbunden, im Ruhezustand oder jetzt mit einer anderen Nummer",
  "button-key-unknown": "es gibt keine Taste {key}; evtest zeigt, wie eine heißt",
  "button-no-input": "{path} ist kein Eingabegerät",
  "button-no-key": "{device} hat keine Taste {key}; {listed}",
  "button-no-lines": "das Programm an {path} sendet keine Zeilen",
  "button-no-listener": "an {path} nimmt nichts an; das Programm starten, das den Taster hat",
  "button-no-socket": "es gibt keinen Socket {path}; das Programm starten, das den Taster hat",
  "button-no-state": "das Programm an {path} gibt den Zustand des Tasters nicht an",
  "button-no-words": "das Programm an {path} sendet weder „down“ noch „up“",
  "button-not-installed":
    "die Bibliothek evdev ist nicht installiert: pip install -r deploy/requirements-button.lock, was sie übersetzt (Debian: apt-get install gcc python3-dev linux-libc-dev) ({error})",
  "button-not-permitted":
    "dieses Programm darf {path} nicht öffnen; deploy/udev/60-muster.rules in /etc/udev/rules.d installieren oder den Benutzer in die Gruppe input aufnehmen",
  "button-several-keys": "{device} hat {count, number} Tasten; eine mit ?key= angeben; {listed}",
  "button-stuck":
    "seit {pressed_s} gedrückt: Er klemmt, oder etwas liegt darauf; bis er losgelassen wird, ist er nicht zu benutzen",
  "button-taken": "ein anderes Programm hat ihn für sich; dieses beenden",
  "button-unknown": "es gibt kein Eingabegerät {name}; {listed}",
  "button-unreadable": "nicht lesbar: {reason}",
  "buttons-several":
    "es gibt {count, number} Eingabegeräte {name} ({paths}); den Pfad eines davon schreiben, aus /dev/input/by-id oder by-path",
  "commands-not-kept": "offene Befehle würden einen Neustart nicht überstehen: {error}",
  "commands-not-read": "welche Befehle offen waren, ist nicht lesbar: {error}",
  "device-barometer": "Barometer {name}",
  "device-battery": "Akku {name}",
  "device-bus-silent": "keine Antwort auf dem Bus; Leitungen und Versorgung prüfen",
  "device-busy": "ein anderes Programm benutzt es; dieses beenden",
  "device-button": "Taster {name}",
  "device-clock-ahead": "seine Uhr sprang {step_s} vor: Sie wurde gestellt; die Zeit läuft ab jetzt weiter",
  "device-clock-back": "seine Uhr sprang {step_s} zurück: neu gestartet oder gestellt; die Zeit läuft ab jetzt weiter",
  "device-gps": "GPS-Empfänger an {place}",
  "device-gps-of-gpsd": "GPS-Empfänger{of_device} von gpsd an {place}",
  "device-inertial": "Inertialsensor {name}",
  "device-io-error": "keine Antwort (Ein-/Ausgabefehler); Leitungen und Versorgung prüfen",
  "device-magnetometer": "Magnetometer {name}",
  "device-no-value": "noch kein Wert",
  "device-not-permitted":
    "dieses Programm darf {path} nicht öffnen; {rules} in /etc/udev/rules.d installieren und den Benutzer in die Gruppe muster aufnehmen",
  "device-of-kinds":
    "{kinds, select, in_accel_in_anglvel {Beschleunigungssensor und Drehratensensor} in_accel {Beschleunigungssensor} in_anglvel {Drehratensensor} other {{kinds}}} {name}",
  "device-output": "Ausgabe {name}",
  "device-read-only":
    "nicht einstellbar, da der Dienst es nur lesen darf; die Zeile ReadWritePaths ergänzen, die in muster-unit.service steht",
  "device-removed": "es wurde entfernt",
  "device-samples-late":
    "seine Messwerte kommen seit {within_s} um {late_s} zu spät: Die Leitung ist zu langsam, oder seine Uhr wurde gestellt",
  "device-temperature": "Temperatursensor {name} ({settings})",
  "device-timeout": "keine rechtzeitige Antwort; Leitungen und Versorgung prüfen",
  "device-unknown": "{kind} {name} gibt es nicht; {listed}",
  "devices-more": "es gibt {there} und {more, number} weitere",
  "devices-none": "es gibt gar keines",
  "devices-several": "es gibt {count, number} mit dem Namen {name}; eines davon schreiben: {names}",
  "devices-there": "es gibt {there}",
  "fault-of": "{subject}: {fault}",
  "gps-binary":
    "er sendet die binären Meldungen von u-blox und kein NMEA; NMEA in seinen Einstellungen einschalten oder ihn von gpsd lesen lassen",
  "gps-ended": "er hat die Verbindung beendet; läuft sein Programm?",
  "gps-garbled":
    "{garbled, number} von {received, number} Zeilen in {within_s} waren nicht lesbar, etwa {first}; {hint}",
  "gps-hangs": "er nennt immer wieder denselben Zeitpunkt: Er hängt; aus- und einschalten",
  "gps-hint-gpsd": "ist dies der Port von gpsd (2947)?",
  "gps-hint-line": "ist das Kabel gut, dies das richtige Gerät und bei einer seriellen Leitung ?baud= richtig?",
  "gps-no-fixes": "keine Positionen: {reason}",
  "gps-no-places":
    "er sendet {kinds} und keine Sätze GGA, GNS oder RMC; GGA und RMC in seinen Einstellungen einschalten",
  "gps-no-receiver": "was kommt, ist von keinem Empfänger: {garbled}; {hint}",
  "gps-nothing": "die Leitung ist offen, und nichts kommt; ist er an und das Kabel gesteckt?",
  "gps-silent": "er ist verstummt; ist er an und das Kabel gesteckt?",
  "gpsd-no-receiver": "gpsd hat keinen Empfänger; ist er angeschlossen und in /etc/default/gpsd genannt?",
  "gpsd-other-receiver": "gpsd hat keinen Empfänger {device}, sondern {present}; einen davon angeben",
  "gpsd-silent": "gpsd erhält nichts von seinem Empfänger; ist dieser an und das Kabel gesteckt?",
  "gyro-stuck": "der Drehratensensor hat einen Wert wiederholt, während sich das Gerät bewegte",
  "iio-lost":
    "{lost, number} von {known, number} Messwerten in 10 s gingen verloren: Dieser Rechner ist überlastet oder der Bus zu langsam",
  "iio-mag-found":
    "er hat ein Magnetometer und galt als einer ohne, bevor er da war: das Programm des Geräts neu starten",
  "iio-mag-not-captured": "sein Treiber erfasst sein Magnetometer nicht: Dieses wird nicht gelesen",
  "iio-mag-stuck": "sein Magnetometer wiederholt seit {stuck_s} einen Wert: Es hängt",
  "iio-mount-matrix": "seine Einbaumatrix ist „{text}“, was keine Drehung ist; mount-matrix im Gerätebaum berichtigen",
  "iio-no-capture":
    "sein Treiber startet die Erfassung nicht (ungültiges Argument); vielleicht braucht er einen Auslöser: ?trigger=NAME schreiben",
  "iio-no-channel":
    "{name} hat keinen {kind, select, in_accel {Beschleunigungssensor} in_anglvel {Drehratensensor} other {{kind}}}; {listed}{hint}",
  "iio-no-mag": "er hat kein Magnetometer",
  "iio-no-trigger": "es gibt keinen Auslöser {name}; {listed}",
  "iio-no-type": "„{text}“ ist kein Typ eines Abtastwerts",
  "iio-not-captured": "sein Treiber erfasst {channels} nicht",
  "iio-nothing":
    "sein Puffer ist eingeschaltet, und nichts kommt; seine Interruptleitung und interrupts im Gerätebaum prüfen",
  "iio-offers-no-numbers": "er bietet „{offered}“, wo positive Zahlen stehen sollten",
  "iio-offers-no-range": "er bietet „{offered}“, was kein [KLEINSTER SCHRITT GRÖSSTER] ist",
  "iio-other-type": "„{text}“ ist ein Typ eines Abtastwerts, der nicht lesbar ist",
  "iio-rate":
    "er gibt {rate_hz, number} Messwerte je Sekunde und ist auf {set_hz, number} eingestellt: Sein Bus oder dieser Rechner ist zu langsam, oder er kann ?rate= nicht",
  "iio-rate-changed":
    "er gibt {rate_hz, number} Messwerte je Sekunde und galt als einer mit {described_hz, number}, bevor er da war: das Programm des Geräts neu starten",
  "iio-rate-not-offered":
    "er bietet nicht {asked_hz, number} Messwerte je Sekunde, sondern {offered}; er gibt {rate_hz, number}: diese oder andere, die er bietet, mit ?rate= angeben",
  "iio-silent": "{device}: seit {silent_s} keine: {reason}",
  "iio-slow": "das Lesen dauert zu lange",
  "iio-times":
    "{unplaced, number} von {known, number} Messwerten in 10 s kamen mit einer Zeit, die schon war oder nicht sein kann, und wurden ausgelassen",
  "iio-times-impossible": "seine Messwerte haben unmögliche Zeiten; sein Treiber stempelt sie nicht",
  "iio-two-devices": "; Beschleunigungs- und Drehratensensor aus zwei Geräten schreibt man ACCEL+GYRO",
  "journal-damaged": "das Journal ist beschädigt ({damage}); es bleibt, wie es ist, und ein neues wird begonnen",
  "journal-hangs": "das Journal hängt: Der Datenträger antwortet seit {silent_s} nicht",
  "journal-of-other-unit":
    "der Ordner enthielt das Journal eines anderen Geräts, wie kopiert; es liegt jetzt beiseite als {file}",
  "journal-set-aside": "das Journal war beschädigt und liegt beiseite als {file}",
  "journal-unusable": "das Journal {path} ist nicht benutzbar: {error}",
  "line-busy": "ein anderes Programm liest davon; dieses beenden",
  "line-gone": "es ist verschwunden; ist das Kabel gesteckt und das Gerät an und geladen?",
  "line-no-answer": "keine Antwort; ist es an und dieser Rechner in seinem Netz?",
  "line-no-device": "dieses Gerät gibt es nicht; ist das Kabel gesteckt und das Gerät an?",
  "line-no-port": "es ist keine serielle Schnittstelle; den Pfad prüfen",
  "line-no-route": "zu dieser Adresse führt kein Weg; ist dieser Rechner in seinem Netz?",
  "line-not-permitted":
    "dieses Programm darf nicht davon lesen; seinen Benutzer in die Gruppe aufnehmen, der es gehört (dialout)",
  "line-refused": "die Verbindung wird abgelehnt; stimmt der Port, und ist es der des Geräts?",
  "line-unknown-name": "der Name {host} ist hier nicht bekannt; die Adresse prüfen",
  "mayday-not-kept": "der Stand des Maydays würde einen Neustart nicht überstehen: {error}",
  "mayday-not-read": "ob ein Mayday bestand, ist nicht lesbar: {error}",
  "no-reading": "kein Messwert: {reason}",
  "no-samples": "keine Messwerte: {reason}",
  "output-no-sound": "{player} spielt nichts auf {device}: {complaint}; `{player} -L` listet die Geräte",
  "pressure-impossible": "es zeigt {pressure_pa, number} Pa, was kein Luftdruck ist",
  "program-error": "{kind}: {error}",
  "reading-hangs": "seit {silent_s} kein Messwert: es hängt",
  "reading-no-number": "es zeigt keine Zahl",
  "reading-stuck": "es wiederholt seit {stuck_s} einen Wert: es hängt",
  "samples-clock-back": "die Uhr der Messwerte sprang um {back_s} zurück",
  "samples-missing": "{missing_s} lang kein Inertialmesswert",
  "samples-unusable": "1 s lang kein brauchbarer Inertialmesswert",
  "sensor-back": "{sensor} ist wieder da",
  "sensor-clock":
    "die Uhr von {sensor} geht gegenüber {others} {off_s} {side, select, behind {nach} other {vor}}: Sie wird nach dem Eintreffen der Messwerte angeglichen",
  "sensor-gone": "{sensor} gibt seit {silent_s} keine Messwerte; mit {present} geht es weiter",
  "sensor-stuck": "der Inertialsensor hat 1 s lang einen Wert wiederholt",
  "source-ended": "von dort kommt nichts mehr",
  "source-failed": "ausgefallen: {error}",
  "source-silent": "die Sensoren geben seit {silent_s} nichts",
  "speech-hangs": "{speaker} hängt",
  "temperature-chip-fault": "Unterbrechung oder Kurzschluss: Der Chip meldet einen Fehler seines Sensors",
  "temperature-impossible":
    "er zeigt {shown}, was nicht zwischen {least_degc} und {most_degc} liegt: Der Sensor ist unterbrochen, kurzgeschlossen oder falsch eingestellt",
  "temperature-no-input": "{device} hat keinen Eingang {name}; {listed}",
  "temperature-of-machine":
    "{name} misst den Rechner selbst, nicht die Luft um ihn; für die eigene Temperatur des Geräts role=electronics schreiben",
  "temperature-unknown": "{device} hat keine Temperatur {name}; {listed}",
  "temperatures-several": "{device} hat {count, number} Temperaturen; {listed}",
  "thermocouple-fault": "Unterbrechung oder Kurzschluss: Der Wandler meldet einen Fehler seines Thermoelements",
  "thermocouple-open": "Unterbrechung: Das Thermoelement ist gebrochen oder nicht angeschlossen",
  "thermocouple-short": "Kurzschluss: Über- oder Unterspannung am Eingang des Thermoelements",
  "tracker-failed":
    "das Tracking ist beim Start ausgefallen ({error}): Der Taster funktioniert, und das Programm startet eine halbe Minute später neu",
  "tracker-leg-implausible":
    "die Beinlänge von {leg_m} passt zu niemandem oder nicht zur eingestellten Größe: Tracker {tracker} nimmt eines nach der Größe, sonst ein übliches; wearer.leg_length_m (Hüftgelenk bis Sohle, in Metern) oder wearer.height_m berichtigen",
  "tracker-made-for":
    "Tracker {tracker} ist für {places} gemacht, und der Sensor sitzt an {place}: tracker auf {auto} setzen",
  "tracker-needs":
    "Tracker {tracker} braucht je einen Sensor an {needed}, und dieses Gerät hat {has}: Stattdessen wird {instead} benutzt",
  "tracker-no-compass":
    "Tracker {tracker} hält seine Richtung mit dem Kompass, und der Sensor hat kein Magnetometer: Die Richtung driftet",
  "tracker-unused": "Tracker {tracker} benutzt {used}; {unused} wird nur aufgezeichnet",
  "tracker-usual-leg":
    "Tracker {tracker} nimmt eine übliche Beinlänge an, da keine eingestellt ist: Strecken sind um so viel falsch wie diese; wearer.leg_length_m oder wearer.height_m angeben",
  "ximu-ended": "es hat die Verbindung beendet; ist es an und geladen?",
  "ximu-error": "es meldet einen Fehler: {error}",
  "ximu-garbled":
    "{garbled, number} von {received, number} Meldungen in {within_s} waren nicht lesbar, etwa {first}; Kabel, Funk oder ?baud= prüfen",
  "ximu-no-inertial": "es sendet keine Inertialmeldungen; seinen Teiler der Inertialmeldungen auf 1 setzen",
  "ximu-nothing":
    "die Leitung ist offen, und nichts kommt; ist das Gerät an, und sind seine Datenmeldungen für diese Leitung eingeschaltet?",
  "ximu-other-device":
    "was kommt, ist von keiner x-IMU3: {garbled}; ist dies das richtige Gerät und bei einer seriellen Leitung ?baud= richtig?",
  "ximu-rate":
    "es sendet {rate_hz, number} Messwerte je Sekunde, eingestellt sind {set_hz, number}; seinen Teiler der Inertialmeldungen auf 1 setzen (400 je Sekunde) oder ?rate= auf die gesendete Rate",
  "ximu-silent": "es ist verstummt; ist es an, in Reichweite und geladen?",
};
