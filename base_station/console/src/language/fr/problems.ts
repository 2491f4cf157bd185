/** Problems of the station and of a department, by the codes of their sentences, in French. */
import type { Part } from "../catalogue";

export const problem: Part<"problem"> = {
  "acted-apart":
    "Pendant que les stations étaient séparées, on a agi sur {station} ({count, number} fois), et cela n’est pas en vigueur ici : l’audit l’indique ; refaire ce qui importe encore",
  "archive-away":
    "Les interventions closes ne sont plus archivées depuis {minutes}, {waiting, number} en attente : {reason}",
  "bus-plain":
    "Le bus est en TCP non chiffré : toute machine qui l’atteint peut se faire passer pour n’importe quel boîtier",
  "certificate-expired":
    "Le certificat {holder, select, console {de la console} this_station {de cette station} first_station {de la première station} station {de la station {name}} operator {de l’opérateur {name}} tracker {de l’agent de suivi de {name}} other {du boîtier {name}}} a expiré le {ends_utc_s} : {command}",
  "certificate-expires":
    "Le certificat {holder, select, console {de la console} this_station {de cette station} first_station {de la première station} station {de la station {name}} operator {de l’opérateur {name}} tracker {de l’agent de suivi de {name}} other {du boîtier {name}}} expire {days, plural, =0 {dans moins d’un jour} one {dans # jour} other {dans # jours}} : {command}",
  "certificate-renewed":
    "Le certificat de cette station a été renouvelé. La station redémarre avec lui, ce qui prend quelques secondes, à la clôture de l’intervention, ou une heure avant la fin de l’actuel ({ends_utc_s})",
  "checkpoint-refused":
    "L’état en direct ne peut pas être enregistré ({error}) : libérer le disque",
  "clock-ahead":
    "L’horloge de cette machine avance de {off_s} sur l’heure enregistrée, qui ne saute pas sur une station de secours ni pendant une intervention : la régler, ou clore l’intervention",
  "clock-before-certificates":
    "L’horloge de cette machine indique {now_utc_s}, et des certificats commencent le {begins_utc_s} : la régler ; aucune liaison ne se fait avec eux avant",
  "clock-behind":
    "L’horloge de cette machine retarde de {off_s} sur le dernier enregistrement : la régler. Les heures continuent de là en attendant",
  "connections-refused":
    "{count, number} connexions au bus ont été refusées dans la dernière minute ({total, number} depuis le démarrage du routeur), dont {of_network, number} de {network}, la plupart pour : {reason, select, silent {pas de salutation à temps} ended {fin avant une salutation} not_tls {pas de TLS, ou pas de certificat de l’autorité de cette station} not_enrolled {un certificat révoqué ou absent de la liste} banned {un titulaire exclu pour un moment} too_often {plus de liaisons d’un titulaire que permis} other {plus de connexions simultanées que permis}}. Les boîtiers sont admis malgré tout ; voir docs/howto/when-attacked.md",
  "console-name-not-certified":
    "Le certificat de la console ne vaut pas pour {name}, et les navigateurs avertissent : en créer un avec « muster pki renew-station --host {name} », et --host pour chaque autre nom et adresse",
  "console-not-announced":
    "Les navigateurs ne trouvent pas cette console sous {name} : {error}",
  "database-authority-unread":
    "le certificat de l’autorité qui a émis celui du serveur de base de données est illisible ({reason})\u00a0: le donner au format PEM dans sslrootcert de l’adresse",
  "database-certificate-name":
    "le certificat du serveur de base de données vaut pour un autre nom ({reason})\u00a0: écrire dans l’adresse le nom pour lequel il vaut, ou donner au serveur un certificat pour son nom",
  "database-certificate-refused":
    "le certificat du serveur de base de données n’est pas accepté ({reason})\u00a0: il a expiré, n’est pas encore valable, ou vient d’une autre autorité que celle de sslrootcert dans l’adresse\u00a0; vérifier ses dates (openssl x509 -noout -dates -issuer) et l’horloge de cette machine",
  "database-unencrypted":
    "le serveur de base de données n’a pas de certificat ({reason})\u00a0: activer ssl sur le serveur",
  "database-unreachable": "le serveur de base de données ne répond pas ({reason})",
  "database-away":
    "{reason} ; les personnes sont affichées et commandées comme avant, et le journal a tout ; connexions, interventions passées, utilisateurs et personnes attendent la base de données ; vérifier que le serveur fonctionne et est joignable",
  "database-catching-up":
    "Ce qui a été décidé pendant que la base de données ne répondait pas y est reporté depuis le journal",
  "database-changes-dropped":
    "{count, number} modifications ne sont pas entrées dans la base de données ({reason}) ; le journal les a : lancer « muster base rebuild » une fois la cause écartée",
  "database-changes-refused":
    "{count, number} modifications faites pendant que le disque n’acceptait rien ne sont pas dans la base de données, car d’autres y ont été faites entre-temps : revoir les utilisateurs et les personnes",
  "database-damaged":
    "La base de données est endommagée : {damage}",
  "database-gone":
    "La base de données avait disparu ou était vide et a été refaite depuis le journal ; {loss}",
  "database-in-memory":
    "La base de données est tenue en mémoire, car son disque n’accepte rien : les modifications seront écrites dès qu’il le pourra, et perdues si la station s’arrête avant ; {reason}",
  "database-in-memory-without-trails":
    "La base de données est tenue en mémoire, car son disque n’accepte rien : les modifications seront écrites dès qu’il le pourra, et perdues si la station s’arrête avant ; les parcours des interventions passées ne peuvent pas être affichés ; {reason}",
  "database-made-again":
    "La base de données était endommagée ({damage}) et a été refaite depuis le journal ; {loss}. {file} ; vérifier le disque",
  "department-away":
    "Le service ({addresses}) est absent depuis {away_s} : {reason}. Ce qui lui manque est gardé et envoyé plus tard",
  "department-events-missing":
    "{count, number} événements de {station} manquent ici : la base de données de ce service est plus ancienne que ce qu’elle a confirmé. Le journal de la station les a",
  "department-reports-unreadable":
    "{count, number} rapports de stations n’ont pas pu être lus : ce Muster est-il plus ancien ?",
  "department-same-station":
    "Plusieurs machines se présentent comme {station} : {hosts}. Les personnes de toutes sont affichées ; donner à chaque station son propre enrôlement, et révoquer celui-ci",
  "department-station-clock":
    "L’horloge de {station} {side, select, ahead {avance} other {retarde}} de {off_s} sur celle du service : les heures sont affichées selon l’horloge du service ; régler celle qui est fausse",
  "erased-in-archive":
    "{count, plural, one {# copie} other {# copies}} dans l’archive {archive}, peut-être avec des personnes oubliées ; cela est refait",
  "erased-in-archive-away":
    "{count, plural, one {# copie} other {# copies}} dans l’archive {archive}, peut-être avec des personnes oubliées ; cela sera refait plus tard : {reason}",
  "erased-in-other-archive":
    "{count, plural, one {# copie} other {# copies}} dans l’archive {archive}, peut-être avec des personnes oubliées, et la station n’y copie pas : lancer muster base archive copy {archive}",
  "erasure-under-way":
    "Le journal est réécrit pour oublier {kind, select, person {une personne} incident {une intervention} other {{kind}}} ({share_fraction}), à la demande de {by}",
  "erasure-waits":
    "Le journal est réécrit pour oublier {kind, select, person {une personne} incident {une intervention} other {{kind}}} ({share_fraction}), à la demande de {by} : {reason}",
  "journal-floods":
    "Le journal de {unit_id} apporte plus qu’un boîtier n’envoie en des heures ({most, number} messages, {most_mb} ou {most_alerts, number} alertes) : le reste est repris lentement. S’il n’a pas été longtemps hors de portée, l’éteindre ou le révoquer : muster pki revoke {unit_id}",
  "log-damaged":
    "Une partie du journal n’est plus lisible ({files}) : vérifier le disque. {remedy, select, other_station {Ce qui manque est récupéré auprès de l’autre station dès qu’elle est joignable} other {Les messages des boîtiers sont repris de leurs journaux ; pour le reste, restaurer le fichier depuis une sauvegarde}}",
  "log-disk-hangs":
    "Impossible d’écrire dans {folder} : le disque ne répond pas ; le vérifier",
  "log-files-gone":
    "Des fichiers du journal ont disparu, numéros {segments} : vérifier le disque, les restaurer depuis une sauvegarde et redémarrer la station",
  "log-foreign-files":
    "Des fichiers du dossier du journal n’en font pas partie et sont ignorés ({files}) : voir qui les y a mis, et les déplacer",
  "log-little-room":
    "il ne reste que {free_mb} pour le journal dans {folder} : libérer le disque",
  "log-part-lost":
    "Une partie du journal est perdue : {lost} : vérifier le disque. {remedy, select, other_station {Ce qui manque est récupéré auprès de l’autre station dès qu’elle est joignable} other {Les messages des boîtiers sont repris de leurs journaux ; pour le reste, restaurer le fichier depuis une sauvegarde}}",
  "log-records-lost":
    "le journal ne peut pas être écrit dans {folder} ({error}) : {waiting_mb} attendent en mémoire, {lost, number} enregistrements sont perdus ; libérer ou réparer le disque",
  "log-records-missing":
    "le disque n’a pas suivi : {lost, number} enregistrements manquent dans le journal, de {from_utc_s} à {until_utc_s}",
  "log-waits":
    "le journal ne peut pas être écrit dans {folder} ({error}) : {waiting_mb} attendent en mémoire ; libérer ou réparer le disque",
  "messages-left-out":
    "Les messages arrivent plus vite que cette machine ne peut les prendre ; {count, number} ont été laissés, et sont repris des journaux des boîtiers",
  "messages-not-kept":
    "Messages pour lesquels le journal d’un boîtier n’avait plus de place depuis son démarrage : {counts}. Ceux que la liaison a aussi perdus manquent : libérer ou remplacer le disque du boîtier",
  "messages-unreadable":
    "{count, number} messages n’ont pas pu être lus ; le dernier : {last}",
  "part-ended":
    "Une partie de la station s’est arrêtée par une erreur du programme ({name}) : redémarrer la station au prochain moment calme, et signaler l’erreur",
  "part-failed":
    "Une partie de la station ({part}) a échoué : {error} ; merci de le signaler",
  "radio-not-recorded":
    "Le canal radio {name} n’est pas enregistré : {reason}",
  "recorder-stopped":
    "l’enregistreur s’est arrêté et rien n’est journalisé ({error}) : le redémarrer",
  "restart-storm":
    "Le programme d’un boîtier démarre anormalement souvent ({key}) : ignoré",
  "router-away":
    "Le routeur du bus est absent et redémarre ; aucun boîtier n’est relié",
  "rule-failed":
    "La règle d’alarme « {rule} » a échoué pour {unit_id} et n’a pas jugé : {error}",
  "secret-open":
    "{path} peut être lu ou modifié par d’autres, et cela ne peut être retiré ({error}) : le donner à l’utilisateur de la station avec le mode 0600 ; {remedy, select, authority_key {elle permet d’enrôler n’importe quel boîtier : si des inconnus utilisent cette machine, créer une nouvelle autorité et enrôler de nouveau tous les boîtiers} station_key {elle permet à une machine de se faire passer pour cette station : si des inconnus utilisent celle-ci, créer une nouvelle autorité et enrôler de nouveau tous les boîtiers} first_login {donner un autre mot de passe à l’administrateur} database_password {si des inconnus utilisent cette machine, donner un autre mot de passe à l’utilisateur de la base de données} database {si des inconnus utilisent cette machine, donner un autre mot de passe à chaque utilisateur} other {si des inconnus utilisent cette machine, créer une autre clé}}",
  "secret-was-open":
    "{path} pouvait être lu ou modifié par d’autres (mode {mode}) et leur a été fermé ; {remedy, select, authority_key {elle permet d’enrôler n’importe quel boîtier : si des inconnus utilisent cette machine, créer une nouvelle autorité et enrôler de nouveau tous les boîtiers} station_key {elle permet à une machine de se faire passer pour cette station : si des inconnus utilisent celle-ci, créer une nouvelle autorité et enrôler de nouveau tous les boîtiers} first_login {donner un autre mot de passe à l’administrateur} database_password {si des inconnus utilisent cette machine, donner un autre mot de passe à l’utilisateur de la base de données} database {si des inconnus utilisent cette machine, donner un autre mot de passe à chaque utilisateur} other {si des inconnus utilisent cette machine, créer une autre clé}}",
  "sender-floods":
    "{sender_id} envoie plus qu’aucun boîtier (plus de {most, number} messages ou {most_mb} par seconde) : l’excès est rejeté. L’éteindre ou le révoquer : muster pki revoke {sender_id}",
  "sender-forged":
    "Un émetteur sur le bus prétend être la station ({key}) : rejeté",
  "sender-shut-out":
    "{sender_id} ({reason}) : exclu pour {minutes}, car il gêne les autres ; son porteur est injoignable entre-temps : demander par radio. Échanger le boîtier, ou le révoquer : muster pki revoke {sender_id}",
  "standby-behind":
    "La station de secours est en retard : ce qui se fait maintenant n’est que sur cette station",
  "standby-cut-off":
    "Aucun message de {station} ni d’un boîtier n’arrive : cette station est probablement isolée. Elle prend le relais dès qu’elle reçoit un boîtier, ou à la main",
  "standby-disk":
    "Le disque de cette station de secours n’accepte pas le journal : le libérer ou le réparer ; ce qui manque sera alors repris",
  "standby-empty":
    "Aucune station active n’est joignable, et cette nouvelle station de secours n’a encore rien : elle attend",
  "standby-fetching":
    "Cette station de secours n’a pas encore tout de la station active",
  "standby-lacks-log":
    "{station} n’est pas joignable, et cette station de secours n’en a pas tout : elle attend {wait_s} son retour, puis prend le relais, ou à la main",
  "standby-none":
    "Il n’y a pas de station de secours : ce qui se fait maintenant n’est que sur cette station",
  "standby-other-version":
    "La station {station} est d’une autre version : les deux ne peuvent se suppléer tant qu’elles ne sont pas mises à jour",
  "standby-same-name":
    "Deux stations s’appellent {station} : donner à chacune son propre nom dans [standby]",
  "standby-takes-over":
    "Aucune station active n’est joignable : celle-ci prend le relais dans quelques secondes",
  "state-stale":
    "Ce que le disque avait perdu du journal est revenu, et la situation de cette station a été faite sans lui. Elle est refaite dès que l’autre station est à jour et qu’aucune intervention n’est ouverte ; pour l’avoir maintenant, laisser l’autre prendre le relais",
  "station-not-announced":
    "La station n’est pas annoncée sur son réseau : {error}",
  "station-not-certified":
    "Les boîtiers ne découvrent pas cette station à {addresses}, car son certificat ne vaut pas pour cela : en créer un avec « muster pki renew-station », et --host pour chaque adresse",
  "tak-away":
    "La connexion TAK « {name} » ({url}) est absente depuis {away_s} : {reason}",
  "unregistered-messages":
    "{count, number} messages de plus de boîtiers non enregistrés que ce qui est affiché",
};
