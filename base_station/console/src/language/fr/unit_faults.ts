/** Faults that units report, by the codes of their sentences, in French. */
import type { Part } from "../catalogue";

export const unit_fault: Part<"unit_fault"> = {
  "accel-stuck": "l’accéléromètre a répété une valeur pendant que le boîtier tournait",
  "attribute-no-number": "{attribute} vaut «\u00a0{text}\u00a0», ce qui n’est pas un nombre",
  "batteries-several": "il y a {count, number} batteries\u00a0; indiquer l’une d’elles\u00a0: {there}",
  "batteries-there": "il y a {there}",
  "battery-no-charge": "elle n’indique aucune charge entre 0 et 100 %",
  "battery-none": "cette machine n’a pas de batterie que le noyau indique",
  "battery-out": "aucune batterie n’est en place",
  "battery-unknown": "il n’y a pas de batterie {name}\u00a0; {listed}",
  "black-box-fails": "la boîte noire échoue\u00a0: {error}",
  "black-box-hangs": "la boîte noire est bloquée\u00a0: le disque ne répond pas depuis {silent_s}",
  "black-box-stopped": "la boîte noire s’est arrêtée",
  "button-ended": "le programme de {path} s’est terminé",
  "button-gone": "{path} n’existe pas\u00a0: non connecté, en veille ou avec un autre numéro à présent",
  "button-key-unknown": "il n’y a pas de touche {key}\u00a0; evtest montre le nom d’une touche",
  "button-no-input": "{path} n’est pas un périphérique d’entrée",
  "button-no-key": "{device} n’a pas de touche {key}\u00a0; {listed}",
  "button-no-lines": "le programme de {path} n’envoie pas de lignes",
  "button-no-listener": "rien n’écoute sur {path}\u00a0; démarrer le programme qui gère le bouton",
  "button-no-socket": "il n’y a pas de socket {path}\u00a0; démarrer le programme qui gère le bouton",
  "button-no-state": "le programme de {path} n’indique pas l’état du bouton",
  "button-no-words": "le programme de {path} n’envoie ni «\u00a0down\u00a0» ni «\u00a0up\u00a0»",
  "button-not-installed":
    "la bibliothèque evdev n’est pas installée\u00a0: pip install -r deploy/requirements-button.lock, qui la compile (Debian\u00a0: apt-get install gcc python3-dev linux-libc-dev) ({error})",
  "button-not-permitted":
    "ce programme ne peut pas ouvrir {path}\u00a0; installer deploy/udev/60-muster.rules dans /etc/udev/rules.d, ou ajouter l’utilisateur au groupe input",
  "button-several-keys": "{device} a {count, number} touches\u00a0; en indiquer une par ?key=\u00a0; {listed}",
  "button-stuck":
    "appuyé depuis {pressed_s}\u00a0: il est coincé, ou quelque chose repose dessus\u00a0; tant qu’il n’est pas relâché, il est inutilisable",
  "button-taken": "un autre programme se l’est réservé\u00a0; terminer celui-ci",
  "button-unknown": "il n’y a pas de périphérique d’entrée {name}\u00a0; {listed}",
  "button-unreadable": "illisible\u00a0: {reason}",
  "buttons-several":
    "il y a {count, number} périphériques d’entrée {name} ({paths})\u00a0; écrire le chemin de l’un d’eux, de /dev/input/by-id ou by-path",
  "commands-not-kept": "les ordres en cours ne survivraient pas à un redémarrage\u00a0: {error}",
  "commands-not-read": "impossible de lire quels ordres étaient en cours\u00a0: {error}",
  "device-barometer": "baromètre {name}",
  "device-battery": "batterie {name}",
  "device-bus-silent": "pas de réponse sur le bus\u00a0; vérifier les fils et l’alimentation",
  "device-busy": "un autre programme l’utilise\u00a0; terminer celui-ci",
  "device-button": "bouton {name}",
  "device-clock-ahead":
    "son horloge a avancé de {step_s}\u00a0: elle a été réglée\u00a0; le temps continue à partir de maintenant",
  "device-clock-back":
    "son horloge a reculé de {step_s}\u00a0: redémarrée, ou réglée\u00a0; le temps continue à partir de maintenant",
  "device-gps": "récepteur GPS sur {place}",
  "device-gps-of-gpsd": "récepteur GPS{of_device} de gpsd sur {place}",
  "device-inertial": "capteur inertiel {name}",
  "device-io-error": "pas de réponse (erreur d’entrée/sortie)\u00a0; vérifier les fils et l’alimentation",
  "device-magnetometer": "magnétomètre {name}",
  "device-no-value": "pas encore de valeur",
  "device-not-permitted":
    "ce programme ne peut pas ouvrir {path}\u00a0; installer {rules} dans /etc/udev/rules.d et ajouter l’utilisateur au groupe muster",
  "device-of-kinds":
    "{kinds, select, in_accel_in_anglvel {accéléromètre et gyroscope} in_accel {accéléromètre} in_anglvel {gyroscope} other {{kinds}}} {name}",
  "device-output": "sortie {name}",
  "device-read-only":
    "réglage impossible, car le service n’y a accès qu’en lecture\u00a0; ajouter la ligne ReadWritePaths qui figure dans muster-unit.service",
  "device-removed": "il a été retiré",
  "device-samples-late":
    "ses échantillons arrivent avec {late_s} de retard depuis {within_s}\u00a0: la ligne est trop lente, ou son horloge a été réglée",
  "device-temperature": "capteur de température {name} ({settings})",
  "device-timeout": "pas de réponse à temps\u00a0; vérifier les fils et l’alimentation",
  "device-unknown": "{kind} {name} n’existe pas\u00a0; {listed}",
  "devices-more": "il y a {there} et {more, number} autres",
  "devices-none": "il n’y en a aucun",
  "devices-several": "il y en a {count, number} nommés {name}\u00a0; écrire l’un d’eux\u00a0: {names}",
  "devices-there": "il y a {there}",
  "fault-of": "{subject}\u00a0: {fault}",
  "gps-binary":
    "il envoie les messages binaires de u-blox et pas de NMEA\u00a0; activer NMEA dans ses réglages, ou le faire lire par gpsd",
  "gps-ended": "il a mis fin à la connexion\u00a0; son programme fonctionne-t-il\u00a0?",
  "gps-garbled":
    "{garbled, number} lignes sur {received, number} en {within_s} étaient illisibles, comme {first}\u00a0; {hint}",
  "gps-hangs": "il donne toujours le même instant\u00a0: il est bloqué\u00a0; l’éteindre et le rallumer",
  "gps-hint-gpsd": "est-ce le port de gpsd (2947)\u00a0?",
  "gps-hint-line": "le câble est-il bon, est-ce le bon appareil et, sur une ligne série, ?baud= est-il juste\u00a0?",
  "gps-no-fixes": "pas de positions\u00a0: {reason}",
  "gps-no-places": "il envoie {kinds} et pas de phrases GGA, GNS ou RMC\u00a0; activer GGA et RMC dans ses réglages",
  "gps-no-receiver": "ce qui arrive ne vient pas d’un récepteur\u00a0: {garbled}\u00a0; {hint}",
  "gps-nothing": "la ligne est ouverte et rien n’arrive\u00a0; est-il allumé, et le câble branché\u00a0?",
  "gps-silent": "il s’est tu\u00a0; est-il allumé, et le câble branché\u00a0?",
  "gpsd-no-receiver": "gpsd n’a pas de récepteur\u00a0; est-il branché, et nommé dans /etc/default/gpsd\u00a0?",
  "gpsd-other-receiver": "gpsd n’a pas de récepteur {device}, mais {present}\u00a0; indiquer l’un d’eux",
  "gpsd-silent": "gpsd ne reçoit rien de son récepteur\u00a0; est-il allumé, et le câble branché\u00a0?",
  "gyro-stuck": "le gyroscope a répété une valeur pendant que le boîtier bougeait",
  "iio-lost":
    "{lost, number} échantillons sur {known, number} en 10 s ont été perdus\u00a0: cette machine est surchargée, ou le bus trop lent",
  "iio-mag-found":
    "il a un magnétomètre, et passait pour un capteur sans magnétomètre avant d’être là\u00a0: redémarrer l’agent du boîtier",
  "iio-mag-not-captured": "son pilote n’acquiert pas son magnétomètre\u00a0: celui-ci n’est pas lu",
  "iio-mag-stuck": "son magnétomètre répète une valeur depuis {stuck_s}\u00a0: il est bloqué",
  "iio-mount-matrix":
    "sa matrice de montage est «\u00a0{text}\u00a0», ce qui n’est pas une rotation\u00a0; corriger mount-matrix dans le device tree",
  "iio-no-capture":
    "son pilote ne démarre pas l’acquisition (argument invalide)\u00a0; il lui faut peut-être un déclencheur\u00a0: écrire ?trigger=NAME",
  "iio-no-channel":
    "{name} n’a pas {kind, select, in_accel {d’accéléromètre} in_anglvel {de gyroscope} other {{kind}}}\u00a0; {listed}{hint}",
  "iio-no-mag": "il n’a pas de magnétomètre",
  "iio-no-trigger": "il n’y a pas de déclencheur {name}\u00a0; {listed}",
  "iio-no-type": "«\u00a0{text}\u00a0» n’est pas un type d’élément acquis",
  "iio-not-captured": "son pilote n’acquiert pas {channels}",
  "iio-nothing":
    "son tampon est activé et rien n’arrive\u00a0; vérifier sa ligne d’interruption, et interrupts dans le device tree",
  "iio-offers-no-numbers": "il propose «\u00a0{offered}\u00a0», là où il faut des nombres positifs",
  "iio-offers-no-range": "il propose «\u00a0{offered}\u00a0», ce qui n’est pas [MINIMUM PAS MAXIMUM]",
  "iio-other-type": "«\u00a0{text}\u00a0» est un type d’élément acquis qui ne peut pas être lu",
  "iio-rate":
    "il donne {rate_hz, number} échantillons par seconde et est réglé sur {set_hz, number}\u00a0: son bus ou cette machine est trop lent, ou ?rate= n’est pas à sa portée",
  "iio-rate-changed":
    "il donne {rate_hz, number} échantillons par seconde et passait pour un capteur à {described_hz, number} avant d’être là\u00a0: redémarrer l’agent du boîtier",
  "iio-rate-not-offered":
    "il ne propose pas {asked_hz, number} échantillons par seconde mais {offered}\u00a0; il en donne {rate_hz, number}\u00a0: l’écrire par ?rate=, ou une autre valeur proposée",
  "iio-silent": "{device} n’en a donné aucun depuis {silent_s}\u00a0: {reason}",
  "iio-slow": "la lecture prend trop de temps",
  "iio-times":
    "{unplaced, number} échantillons sur {known, number} en 10 s portaient un temps déjà passé ou impossible, et ont été écartés",
  "iio-times-impossible": "ses échantillons ont des temps impossibles\u00a0; son pilote ne les horodate pas",
  "iio-two-devices": "\u00a0; accéléromètre et gyroscope de deux appareils s’écrivent ACCEL+GYRO",
  "journal-damaged": "le journal est endommagé ({damage})\u00a0; il est laissé tel quel, et un nouveau est commencé",
  "journal-hangs": "le journal est bloqué\u00a0: le disque ne répond pas depuis {silent_s}",
  "journal-of-other-unit":
    "le dossier contenait le journal d’un autre boîtier, comme copié\u00a0; il est mis de côté sous {file}",
  "journal-set-aside": "le journal était endommagé et est mis de côté sous {file}",
  "journal-unusable": "le journal {path} est inutilisable\u00a0: {error}",
  "line-busy": "un autre programme le lit\u00a0; terminer celui-ci",
  "line-gone": "il a disparu\u00a0; le câble est-il branché, et l’appareil allumé et chargé\u00a0?",
  "line-no-answer": "pas de réponse\u00a0; est-il allumé, et cette machine dans son réseau\u00a0?",
  "line-no-device": "cet appareil n’existe pas\u00a0; le câble est-il branché, et l’appareil allumé\u00a0?",
  "line-no-port": "ce n’est pas un port série\u00a0; vérifier le chemin",
  "line-no-route": "aucune route vers cette adresse\u00a0; cette machine est-elle dans son réseau\u00a0?",
  "line-not-permitted":
    "ce programme ne peut pas le lire\u00a0; ajouter son utilisateur au groupe propriétaire (dialout)",
  "line-refused": "la connexion est refusée\u00a0; le port est-il juste, et bien celui de l’appareil\u00a0?",
  "line-unknown-name": "le nom {host} est inconnu ici\u00a0; vérifier l’adresse",
  "mayday-not-kept": "l’état du mayday ne survivrait pas à un redémarrage\u00a0: {error}",
  "mayday-not-read": "impossible de lire si un mayday était actif\u00a0: {error}",
  "no-reading": "pas de mesure\u00a0: {reason}",
  "no-samples": "pas d’échantillons\u00a0: {reason}",
  "output-no-sound": "{player} ne joue rien sur {device}\u00a0: {complaint}\u00a0; `{player} -L` liste les appareils",
  "pressure-impossible": "il indique {pressure_pa, number} Pa, ce qui n’est pas une pression atmosphérique",
  "program-error": "{kind}\u00a0: {error}",
  "reading-hangs": "pas de mesure depuis {silent_s}\u00a0: il est bloqué",
  "reading-no-number": "il n’indique pas de nombre",
  "reading-stuck": "il répète une valeur depuis {stuck_s}\u00a0: il est bloqué",
  "samples-clock-back": "l’horloge des échantillons a reculé de {back_s}",
  "samples-missing": "aucun échantillon inertiel pendant {missing_s}",
  "samples-unusable": "aucun échantillon inertiel utilisable pendant 1 s",
  "sensor-back": "{sensor} est de retour",
  "sensor-clock":
    "l’horloge de {sensor} est en {side, select, behind {retard} other {avance}} de {off_s} sur {others}\u00a0: elle est alignée d’après l’arrivée de ses échantillons",
  "sensor-gone": "{sensor} n’a donné aucun échantillon depuis {silent_s}\u00a0; {present} continue",
  "sensor-stuck": "le capteur inertiel a répété une valeur pendant 1 s",
  "source-ended": "sa source est épuisée",
  "source-failed": "en panne\u00a0: {error}",
  "source-silent": "la source est muette depuis {silent_s}",
  "speech-hangs": "{speaker} est bloqué",
  "temperature-chip-fault": "circuit ouvert ou court-circuit\u00a0: la puce signale un défaut de son capteur",
  "temperature-impossible":
    "il indique {shown}, ce qui n’est pas entre {least_degc} et {most_degc}\u00a0: le capteur est ouvert, en court-circuit ou mal réglé",
  "temperature-no-input": "{device} n’a pas d’entrée {name}\u00a0; {listed}",
  "temperature-of-machine":
    "{name} mesure la machine elle-même, pas l’air autour\u00a0; écrire role=electronics pour l’avoir comme température du boîtier",
  "temperature-unknown": "{device} n’a pas de température {name}\u00a0; {listed}",
  "temperatures-several": "{device} a {count, number} températures\u00a0; {listed}",
  "thermocouple-fault": "circuit ouvert ou court-circuit\u00a0: le convertisseur signale un défaut de son thermocouple",
  "thermocouple-open": "circuit ouvert\u00a0: le thermocouple est rompu ou non connecté",
  "thermocouple-short": "court-circuit\u00a0: surtension ou sous-tension à l’entrée du thermocouple",
  "tracker-failed":
    "le suivi a échoué à son démarrage ({error})\u00a0: le bouton fonctionne, et l’agent est redémarré une demi-minute plus tard",
  "tracker-leg-implausible":
    "la longueur de jambe de {leg_m} ne convient à personne, ou pas à la taille réglée\u00a0: le tracker {tracker} en prend une d’après la taille, sinon une usuelle\u00a0; corriger wearer.leg_length_m (de la hanche à la semelle, en mètres) ou wearer.height_m",
  "tracker-made-for":
    "le tracker {tracker} est fait pour {places}, et le capteur est porté sur {place}\u00a0: régler tracker sur {auto}",
  "tracker-needs":
    "le tracker {tracker} a besoin d’un capteur à chaque endroit ({needed}), et ce boîtier a {has}\u00a0: {instead} est utilisé à la place",
  "tracker-no-compass":
    "le tracker {tracker} garde son cap à la boussole, et le capteur n’a pas de magnétomètre\u00a0: le cap dérive",
  "tracker-unused": "le tracker {tracker} utilise {used}\u00a0; {unused} est seulement enregistré",
  "tracker-usual-leg":
    "le tracker {tracker} prend une longueur de jambe usuelle, faute de réglage\u00a0: les distances sont fausses d’autant\u00a0; indiquer wearer.leg_length_m ou wearer.height_m",
  "ximu-ended": "il a mis fin à la connexion\u00a0; est-il allumé, et chargé\u00a0?",
  "ximu-error": "il signale une erreur\u00a0: {error}",
  "ximu-garbled":
    "{garbled, number} messages sur {received, number} en {within_s} étaient illisibles, comme {first}\u00a0; vérifier le câble, la radio ou ?baud=",
  "ximu-no-inertial": "il n’envoie pas de messages inertiels\u00a0; régler son diviseur de messages inertiels sur 1",
  "ximu-nothing":
    "la ligne est ouverte et rien n’arrive\u00a0; l’appareil est-il allumé, et ses messages de données activés pour cette ligne\u00a0?",
  "ximu-other-device":
    "ce qui arrive ne vient pas d’une x-IMU3\u00a0: {garbled}\u00a0; est-ce le bon appareil et, sur une ligne série, le bon ?baud=\u00a0?",
  "ximu-rate":
    "il envoie {rate_hz, number} échantillons par seconde, {set_hz, number} sont réglés\u00a0; régler son diviseur de messages inertiels sur 1 (400 par seconde), ou ?rate= sur la cadence envoyée",
  "ximu-silent": "il s’est tu\u00a0; est-il allumé, à portée et chargé\u00a0?",
};
