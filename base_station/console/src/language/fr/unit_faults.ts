/** Faults that units report, by the codes of their sentences, in French. */
import type { Part } from "../catalogue";

export const unit_fault: Part<"unit_fault"> = {
  "accel-stuck": "l’accéléromètre a répété une valeur pendant que l’unité tournait",
  "attribute-no-number": "{attribute} vaut « {text} », ce qui n’est pas un nombre",
  "batteries-several": "il y a {count, number} batteries ; indiquer l’une d’elles : {there}",
  "batteries-there": "il y a {there}",
  "battery-no-charge": "elle n’indique aucune charge entre 0 et 100 %",
  "battery-none": "cette machine n’a pas de batterie que le noyau indique",
  "battery-out": "aucune batterie n’est en place",
  "battery-unknown": "il n’y a pas de batterie {name} ; {listed}",
  "black-box-fails": "la boîte noire échoue : {error}",
  "black-box-hangs": "la boîte noire est bloquée : le disque ne répond pas depuis {silent_s}",
  "black-box-stopped": "la boîte noire s’est arrêtée",
  "button-ended": "le programme de {path} s’est terminé",
  "button-gone": "{path} n’existe pas : non connecté, en veille ou avec un autre numéro à présent",
  "button-key-unknown": "il n’y a pas de touche {key} ; evtest montre le nom d’une touche",
  "button-no-input": "{path} n’est pas un périphérique d’entrée",
  "button-no-key": "{device} n’a pas de touche {key} ; {listed}",
  "button-no-lines": "le programme de {path} n’envoie pas de lignes",
  "button-no-listener": "rien n’écoute sur {path} ; démarrer le programme qui gère le bouton",
  "button-no-socket": "il n’y a pas de socket {path} ; démarrer le programme qui gère le bouton",
  "button-no-state": "le programme de {path} n’indique pas l’état du bouton",
  "button-no-words": "le programme de {path} n’envoie ni « down » ni « up »",
  "button-not-installed":
    "la bibliothèque evdev n’est pas installée : pip install -r deploy/requirements-button.lock, qui la compile (Debian : apt-get install gcc python3-dev linux-libc-dev) ({error})",
  "button-not-permitted":
    "ce programme ne peut pas ouvrir {path} ; installer deploy/udev/60-muster.rules dans /etc/udev/rules.d, ou ajouter l’utilisateur au groupe input",
  "button-several-keys": "{device} a {count, number} touches ; en indiquer une par ?key= ; {listed}",
  "button-stuck":
    "appuyé depuis {pressed_s} : il est coincé, ou quelque chose repose dessus ; tant qu’il n’est pas relâché, il est inutilisable",
  "button-taken": "un autre programme se l’est réservé ; terminer celui-ci",
  "button-unknown": "il n’y a pas de périphérique d’entrée {name} ; {listed}",
  "button-unreadable": "illisible : {reason}",
  "buttons-several":
    "il y a {count, number} périphériques d’entrée {name} ({paths}) ; écrire le chemin de l’un d’eux, de /dev/input/by-id ou by-path",
  "commands-not-kept": "les ordres en cours ne survivraient pas à un redémarrage : {error}",
  "commands-not-read": "impossible de lire quels ordres étaient en cours : {error}",
  "device-barometer": "baromètre {name}",
  "device-battery": "batterie {name}",
  "device-bus-silent": "pas de réponse sur le bus ; vérifier les fils et l’alimentation",
  "device-busy": "un autre programme l’utilise ; terminer celui-ci",
  "device-button": "bouton {name}",
  "device-clock-ahead":
    "son horloge a avancé de {step_s} : elle a été réglée ; le temps continue à partir de maintenant",
  "device-clock-back":
    "son horloge a reculé de {step_s} : redémarrée, ou réglée ; le temps continue à partir de maintenant",
  "device-gps": "récepteur GPS sur {place}",
  "device-gps-of-gpsd": "récepteur GPS{of_device} de gpsd sur {place}",
  "device-inertial": "capteur inertiel {name}",
  "device-io-error": "pas de réponse (erreur d’entrée/sortie) ; vérifier les fils et l’alimentation",
  "device-magnetometer": "magnétomètre {name}",
  "device-no-value": "pas encore de valeur",
  "device-not-permitted":
    "ce programme ne peut pas ouvrir {path} ; installer {rules} dans /etc/udev/rules.d et ajouter l’utilisateur au groupe muster",
  "device-of-kinds":
    "{kinds, select, in_accel_in_anglvel {accéléromètre et gyroscope} in_accel {accéléromètre} in_anglvel {gyroscope} other {{kinds}}} {name}",
  "device-output": "sortie {name}",
  "device-read-only":
    "réglage impossible, car le service n’y a accès qu’en lecture ; ajouter la ligne ReadWritePaths qui figure dans muster-unit.service",
  "device-removed": "il a été retiré",
  "device-samples-late":
    "ses échantillons arrivent avec {late_s} de retard depuis {within_s} : la ligne est trop lente, ou son horloge a été réglée",
  "device-temperature": "capteur de température {name} ({settings})",
  "device-timeout": "pas de réponse à temps ; vérifier les fils et l’alimentation",
  "device-unknown": "{kind} {name} n’existe pas ; {listed}",
  "devices-more": "il y a {there} et {more, number} autres",
  "devices-none": "il n’y en a aucun",
  "devices-several": "il y en a {count, number} nommés {name} ; écrire l’un d’eux : {names}",
  "devices-there": "il y a {there}",
  "fault-of": "{subject} : {fault}",
  "gps-binary":
    "il envoie les messages binaires de u-blox et pas de NMEA ; activer NMEA dans ses réglages, ou le faire lire par gpsd",
  "gps-ended": "il a mis fin à la connexion ; son programme fonctionne-t-il ?",
  "gps-garbled":
    "{garbled, number} lignes sur {received, number} en {within_s} étaient illisibles, comme {first} ; {hint}",
  "gps-hangs": "il donne toujours le même instant : il est bloqué ; l’éteindre et le rallumer",
  "gps-hint-gpsd": "est-ce le port de gpsd (2947) ?",
  "gps-hint-line": "le câble est-il bon, est-ce le bon appareil et, sur une ligne série, ?baud= est-il juste ?",
  "gps-no-fixes": "pas de positions : {reason}",
  "gps-no-places": "il envoie {kinds} et pas de phrases GGA, GNS ou RMC ; activer GGA et RMC dans ses réglages",
  "gps-no-receiver": "ce qui arrive ne vient pas d’un récepteur : {garbled} ; {hint}",
  "gps-nothing": "la ligne est ouverte et rien n’arrive ; est-il allumé, et le câble branché ?",
  "gps-silent": "il s’est tu ; est-il allumé, et le câble branché ?",
  "gpsd-no-receiver": "gpsd n’a pas de récepteur ; est-il branché, et nommé dans /etc/default/gpsd ?",
  "gpsd-other-receiver": "gpsd n’a pas de récepteur {device}, mais {present} ; indiquer l’un d’eux",
  "gpsd-silent": "gpsd ne reçoit rien de son récepteur ; est-il allumé, et le câble branché ?",
  "gyro-stuck": "le gyroscope a répété une valeur pendant que l’unité bougeait",
  "iio-lost":
    "{lost, number} échantillons sur {known, number} en 10 s ont été perdus : cette machine est surchargée, ou le bus trop lent",
  "iio-mag-found":
    "il a un magnétomètre, et passait pour un capteur sans magnétomètre avant d’être là : redémarrer l’agent de l’unité",
  "iio-mag-not-captured": "son pilote n’acquiert pas son magnétomètre : celui-ci n’est pas lu",
  "iio-mag-stuck": "son magnétomètre répète une valeur depuis {stuck_s} : il est bloqué",
  "iio-mount-matrix":
    "sa matrice de montage est « {text} », ce qui n’est pas une rotation ; corriger mount-matrix dans le device tree",
  "iio-no-capture":
    "son pilote ne démarre pas l’acquisition (argument invalide) ; il lui faut peut-être un déclencheur : écrire ?trigger=NAME",
  "iio-no-channel":
    "{name} n’a pas {kind, select, in_accel {d’accéléromètre} in_anglvel {de gyroscope} other {{kind}}} ; {listed}{hint}",
  "iio-no-mag": "il n’a pas de magnétomètre",
  "iio-no-trigger": "il n’y a pas de déclencheur {name} ; {listed}",
  "iio-no-type": "« {text} » n’est pas un type d’élément acquis",
  "iio-not-captured": "son pilote n’acquiert pas {channels}",
  "iio-nothing":
    "son tampon est activé et rien n’arrive ; vérifier sa ligne d’interruption, et interrupts dans le device tree",
  "iio-offers-no-numbers": "il propose « {offered} », là où il faut des nombres positifs",
  "iio-offers-no-range": "il propose « {offered} », ce qui n’est pas [MINIMUM PAS MAXIMUM]",
  "iio-other-type": "« {text} » est un type d’élément acquis qui ne peut pas être lu",
  "iio-rate":
    "il donne {rate_hz, number} échantillons par seconde et est réglé sur {set_hz, number} : son bus ou cette machine est trop lent, ou ?rate= n’est pas à sa portée",
  "iio-rate-changed":
    "il donne {rate_hz, number} échantillons par seconde et passait pour un capteur à {described_hz, number} avant d’être là : redémarrer l’agent de l’unité",
  "iio-rate-not-offered":
    "il ne propose pas {asked_hz, number} échantillons par seconde mais {offered} ; il en donne {rate_hz, number} : l’écrire par ?rate=, ou une autre valeur proposée",
  "iio-silent": "{device} n’en a donné aucun depuis {silent_s} : {reason}",
  "iio-slow": "la lecture prend trop de temps",
  "iio-times":
    "{unplaced, number} échantillons sur {known, number} en 10 s portaient un temps déjà passé ou impossible, et ont été écartés",
  "iio-times-impossible": "ses échantillons ont des temps impossibles ; son pilote ne les horodate pas",
  "iio-two-devices": " ; accéléromètre et gyroscope de deux appareils s’écrivent ACCEL+GYRO",
  "journal-damaged": "le journal est endommagé ({damage}) ; il est laissé tel quel, et un nouveau est commencé",
  "journal-hangs": "le journal est bloqué : le disque ne répond pas depuis {silent_s}",
  "journal-of-other-unit":
    "le dossier contenait le journal d’une autre unité, comme copié ; il est mis de côté sous {file}",
  "journal-set-aside": "le journal était endommagé et est mis de côté sous {file}",
  "journal-unusable": "le journal {path} est inutilisable : {error}",
  "line-busy": "un autre programme le lit ; terminer celui-ci",
  "line-gone": "il a disparu ; le câble est-il branché, et l’appareil allumé et chargé ?",
  "line-no-answer": "pas de réponse ; est-il allumé, et cette machine dans son réseau ?",
  "line-no-device": "cet appareil n’existe pas ; le câble est-il branché, et l’appareil allumé ?",
  "line-no-port": "ce n’est pas un port série ; vérifier le chemin",
  "line-no-route": "aucune route vers cette adresse ; cette machine est-elle dans son réseau ?",
  "line-not-permitted": "ce programme ne peut pas le lire ; ajouter son utilisateur au groupe propriétaire (dialout)",
  "line-refused": "la connexion est refusée ; le port est-il juste, et bien celui de l’appareil ?",
  "line-unknown-name": "le nom {host} est inconnu ici ; vérifier l’adresse",
  "mayday-not-kept": "l’état du mayday ne survivrait pas à un redémarrage : {error}",
  "mayday-not-read": "impossible de lire si un mayday était actif : {error}",
  "no-reading": "pas de mesure : {reason}",
  "no-samples": "pas d’échantillons : {reason}",
  "output-no-sound": "{player} ne joue rien sur {device} : {complaint} ; `{player} -L` liste les appareils",
  "pressure-impossible": "il indique {pressure_pa, number} Pa, ce qui n’est pas une pression atmosphérique",
  "program-error": "{kind} : {error}",
  "reading-hangs": "pas de mesure depuis {silent_s} : il est bloqué",
  "reading-no-number": "il n’indique pas de nombre",
  "reading-stuck": "il répète une valeur depuis {stuck_s} : il est bloqué",
  "samples-clock-back": "l’horloge des échantillons a reculé de {back_s}",
  "samples-missing": "aucun échantillon inertiel pendant {missing_s}",
  "samples-unusable": "aucun échantillon inertiel utilisable pendant 1 s",
  "sensor-back": "{sensor} est de retour",
  "sensor-clock":
    "l’horloge de {sensor} est en {side, select, behind {retard} other {avance}} de {off_s} sur {others} : elle est alignée d’après l’arrivée de ses échantillons",
  "sensor-gone": "{sensor} n’a donné aucun échantillon depuis {silent_s} ; {present} continue",
  "sensor-stuck": "le capteur inertiel a répété une valeur pendant 1 s",
  "source-ended": "sa source est épuisée",
  "source-failed": "en panne : {error}",
  "source-silent": "la source est muette depuis {silent_s}",
  "speech-hangs": "{speaker} est bloqué",
  "temperature-chip-fault": "circuit ouvert ou court-circuit : la puce signale un défaut de son capteur",
  "temperature-impossible":
    "il indique {shown}, ce qui n’est pas entre {least_degc} et {most_degc} : le capteur est ouvert, en court-circuit ou mal réglé",
  "temperature-no-input": "{device} n’a pas d’entrée {name} ; {listed}",
  "temperature-of-machine":
    "{name} mesure la machine elle-même, pas l’air autour ; écrire role=electronics pour l’avoir comme température de l’unité",
  "temperature-unknown": "{device} n’a pas de température {name} ; {listed}",
  "temperatures-several": "{device} a {count, number} températures ; {listed}",
  "thermocouple-fault": "circuit ouvert ou court-circuit : le convertisseur signale un défaut de son thermocouple",
  "thermocouple-open": "circuit ouvert : le thermocouple est rompu ou non connecté",
  "thermocouple-short": "court-circuit : surtension ou sous-tension à l’entrée du thermocouple",
  "tracker-failed":
    "le suivi a échoué à son démarrage ({error}) : le bouton fonctionne, et l’agent est redémarré une demi-minute plus tard",
  "tracker-made-for":
    "le tracker {tracker} est fait pour {places}, et le capteur est porté sur {place} : régler tracker sur {auto}",
  "tracker-needs":
    "le tracker {tracker} a besoin d’un capteur à chaque endroit ({needed}), et cette unité a {has} : {instead} est utilisé à la place",
  "tracker-no-compass":
    "le tracker {tracker} garde son cap à la boussole, et le capteur n’a pas de magnétomètre : le cap dérive",
  "tracker-unused": "le tracker {tracker} utilise {used} ; {unused} est seulement enregistré",
  "tracker-usual-leg":
    "le tracker {tracker} prend une longueur de jambe usuelle, faute de réglage : les distances sont fausses d’autant ; indiquer wearer.leg_length_m ou wearer.height_m",
  "ximu-ended": "il a mis fin à la connexion ; est-il allumé, et chargé ?",
  "ximu-error": "il signale une erreur : {error}",
  "ximu-garbled":
    "{garbled, number} messages sur {received, number} en {within_s} étaient illisibles, comme {first} ; vérifier le câble, la radio ou ?baud=",
  "ximu-no-inertial": "il n’envoie pas de messages inertiels ; régler son diviseur de messages inertiels sur 1",
  "ximu-nothing":
    "la ligne est ouverte et rien n’arrive ; l’appareil est-il allumé, et ses messages de données activés pour cette ligne ?",
  "ximu-other-device":
    "ce qui arrive ne vient pas d’une x-IMU3 : {garbled} ; est-ce le bon appareil et, sur une ligne série, le bon ?baud= ?",
  "ximu-rate":
    "il envoie {rate_hz, number} échantillons par seconde, {set_hz, number} sont réglés ; régler son diviseur de messages inertiels sur 1 (400 par seconde), ou ?rate= sur la cadence envoyée",
  "ximu-silent": "il s’est tu ; est-il allumé, à portée et chargé ?",
};
