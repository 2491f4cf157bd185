/** Refusals about imports, replays, reports, exports and erasure, by their codes, in French. */
import type { Part } from "../catalogue";

export const refusal_past: Part<"refusal_past"> = {
  "alarm-log-unreadable":
    "Le journal est illisible\u00a0: {reason}.",
  "alarm-no-log":
    "Cette station n’a pas de journal à lire.",
  "erase-message-under-way":
    "Un message n’a pas atteint tous ses destinataires, et ne le ferait plus\u00a0: attendez qu’il l’ait fait, ou que son temps soit passé.",
  "erase-name-differs":
    "Le nom est différent\u00a0: donnez-le exactement comme il est montré.",
  "erase-named-open":
    "L’intervention {incident} est en cours\u00a0; clôturez-la d’abord.",
  "erase-wears":
    "{name} porte {units}\u00a0; retirez-les d’abord, ou envoyez unassign.",
  "erase-while-open":
    "L’intervention {incident} est en cours\u00a0; clôturez-la d’abord.",
  "export-no-anchor":
    "Le site n’a pas de place sur la Terre, et ce format ne peut pas être écrit\u00a0: placez l’ancre, ou exportez en CSV",
  "export-no-log":
    "Cette station n’a pas de journal pour le faire.",
  "export-no-track":
    "Aucune des personnes et aucun des boîtiers choisis n’a de trace dans ce temps",
  "export-not-audited":
    "Rien n’est remis que le journal d’audit ne puisse noter\u00a0: {reason}.",
  "import-elsewhere":
    "Le fichier n’est pas à cette station\u00a0: il a été versé à l’autre.",
  "import-heic":
    "Les images HEIC ne sont pas lues\u00a0: enregistrez-la en JPEG, avec ses données Exif",
  "import-no-anchor":
    "Le site de l’intervention n’a pas de place sur la Terre, et rien d’ailleurs ne peut être mis sur son plan\u00a0: placez d’abord l’ancre (Site dans la console)",
  "import-no-photograph":
    "Ce fichier n’est pas une photo.",
  "import-no-place":
    "Le site de l’intervention n’a pas de place sur la Terre.",
  "import-not-of-muster":
    "Rien n’y est de Muster, ou rien n’est lisible\u00a0: {how}",
  "import-not-stored-yet":
    "Le fichier a été versé, mais la base de données ne l’a pas encore pris.",
  "import-not-there":
    "Rien de cet identifiant n’a été versé dans cette intervention.",
  "import-part-of-log":
    "C’est une partie du journal d’une station, pas une intervention à elle seule\u00a0: {how}",
  "import-points-too-many":
    "Le fichier a plus de {most} points, un par seconde\u00a0: coupez-le selon le temps",
  "import-refused":
    "{file} n’a pas été versé\u00a0: {reason}",
  "import-same-incident":
    "C’est cette intervention même, telle que cette station l’a enregistrée",
  "import-too-large":
    "Le fichier a {size_mb}, et au plus {most_mb} sont acceptés",
  "import-took-too-long":
    "La lecture du fichier a pris trop de temps\u00a0: prenez-en une partie",
  "import-tracks-too-many":
    "Le fichier a plus de {most} traces\u00a0: prenez-en une partie",
  "import-unit-recording":
    "C’est l’enregistrement d’un boîtier, pas une intervention\u00a0: suivez-le avec «\u00a0muster edge\u00a0», ou {how}",
  "import-unknown":
    "Cela ne peut pas être versé\u00a0: prenez une trace GPX ou KML, une photo JPEG, PNG, TIFF ou WebP, ou une intervention d’une autre station (MCAP)",
  "import-unreadable":
    "Le fichier est illisible, peut-être endommagé\u00a0; enregistrez-le de nouveau, et versez cela",
  "photo-import-no-place":
    "La photo n’a pas de lieu dans ses données Exif\u00a0: l’appareil n’avait pas de position, ou le lieu a été retiré en chemin\u00a0; prenez le fichier d’origine",
  "photo-import-no-time":
    "Les données Exif de la photo ne disent pas quand elle a été prise",
  "photo-import-too-large":
    "L’image a trop de pixels\u00a0; enregistrez-la plus petite, avec ses données Exif",
  "photo-import-unreadable":
    "Ce n’est pas une image lisible\u00a0: {error}",
  "radio-for-commanders":
    "L’audio de la radio est pour les commandants, et les jetons avec le domaine «\u00a0radio\u00a0».",
  "recording-gone":
    "Aucun enregistrement de ce genre n’est en cours de transfert.",
  "recording-no-unit":
    "Il n’y a pas de boîtier {unit}.",
  "recording-replays-only":
    "Une station qui ne fait que relire n’a pas de boîtiers à interroger.",
  "recording-under-way":
    "Un enregistrement de {unit} est déjà en transfert\u00a0; attendez-le, ou arrêtez-le",
  "recording-window":
    "La période finit avant de commencer\u00a0; inversez les deux heures",
  "recordings-too-many":
    "{most} enregistrements sont en transfert\u00a0; attendez-en un, ou arrêtez-en un",
  "replay-ended-by-commander":
    "Cette relecture est celle de {by}\u00a0; un commandant peut la terminer.",
  "replay-for-all":
    "Cette relecture est pour tous\u00a0; elle se termine avec la commande qui la montre.",
  "replay-gone":
    "Cette relecture n’existe pas\u00a0; elle est peut-être terminée.",
  "replay-of-another":
    "Cette relecture est celle de {by}\u00a0; commencez la vôtre.",
  "replay-speed":
    "Une relecture va de {slowest} à {fastest} fois le temps réel, et non {speed}",
  "replays-too-many":
    "{most} relectures sont déjà ouvertes\u00a0; terminez-en une",
  "rehearsal-by-terminal":
    "Faites l’essai en ligne de commande\u00a0: muster base rehearse --incident {incident}.",
  "rehearsal-none":
    "Il n’y a pas d’essai\u00a0: {reason}.",
  "rehearsal-nothing":
    "aucun seuil n’est donné",
  "rehearsal-open":
    "L’intervention est ouverte\u00a0; faites l’essai une fois qu’elle est terminée.",
  "rehearsal-wrong":
    "Essai non fait\u00a0: {reason}.",
  "report-by-terminal":
    "Faites-le en ligne de commande\u00a0: muster base report {incident}.",
  "report-library-missing":
    "La bibliothèque weasyprint, qui écrit le PDF, n’est pas installée\u00a0: pip install --require-hashes -r deploy/requirements-report.lock\u00a0; ou imprimez le rapport HTML dans un navigateur",
  "report-none":
    "Il n’y a pas de rapport\u00a0: {reason}.",
  "sweep-and-value":
    "{threshold} est donné par une valeur et par une série\u00a0; supprimez l’une des deux",
  "sweep-long":
    "{threshold}\u00a0: {count} valeurs\u00a0; {most} au plus, prenez un pas plus grand",
  "sweep-order":
    "{threshold}\u00a0: une série monte de la première à la dernière valeur par un pas supérieur à 0",
  "timeline-no-log":
    "Cette station n’a pas de journal pour la lire.",
  "timeline-no-unit":
    "Il n’y a pas de boîtier {unit}, ni enregistré ni relié.",
  "timeline-none":
    "Il n’y a pas de chronologie\u00a0: {reason}.",
  "erasure-not-leading":
    "Cette station ne dirige pas ; celle qui dirige l'ordonne.",
  "erasure-after-mending":
    "{part} ; ce qui manque est d'abord repris de l'autre station",
  "unknown-person":
    "Ni l'effectif ni le journal ne connaissent de personne {person_id}.",
  "erasure-memory-timeout":
    "La station n'a pas atteint à temps ce qu'elle tient en mémoire.",
  "erasure-folder-in-use":
    "{folder} ne peut pas être supprimé ; voyez qui l'utilise, puis effacez de nouveau.",
  "radio-channel-empty":
    "De ce canal radio, rien n’a été enregistré.",
  "radio-window-outside":
    "Ce moment n’est pas dans l’intervention.",
  "radio-no-log":
    "Cette station n’a pas de journal.",
  "radio-unreadable":
    "{reason}.",
  "radio-file-unreadable":
    "{path} est illisible ({error})\u00a0: vérifiez le disque",
  "recording-window-unnamed":
    "Indiquez la période\u00a0: une intervention, ou un début et peut-être une fin.",
  "trails-no-log":
    "Cette station n’a pas de journal pour le calculer.",
  "erase-incident-unknown":
    "Le journal ne connaît pas d’intervention {incident}",
  "erase-incident-open":
    "L’intervention {incident} est en cours\u00a0; clôturez-la d’abord",
  "log-process-ended":
    "Le processus qui lisait le journal est terminé\u00a0; redemandez",
  "log-took-too-long":
    "Le journal n’a pas été lu en {longest_s}\u00a0; demandez une période plus courte",
  "trails-process-ended":
    "Ce que l’on sait après coup de {incident} n’a pas été calculé\u00a0: le processus qui le faisait est terminé\u00a0; redemandez",
  "incident-file-damaged":
    "{path} est marqué comme intervention de Muster, mais illisible comme telle ({error})\u00a0: récupérez-le encore une fois",
  "erasure-list-unreadable":
    "{path} indique ce qui est en cours d’effacement et est illisible ({error})\u00a0: restaurez-le d’une sauvegarde, ou supprimez-le et effacez de nouveau",
  "export-format-unknown":
    "Il n’y a pas de format «\u00a0{format}\u00a0»\u00a0; les formats sont {known}",
  "parquet-library-missing":
    "La bibliothèque pyarrow, qui écrit le Parquet, n’est pas installée\u00a0: pip install --require-hashes -r deploy/requirements-parquet.lock",
  "export-selection-unknown":
    "«\u00a0{name}\u00a0» n’est ni un boîtier, ni une personne, ni un binôme avec une trace dans cette intervention\u00a0; il y a {known, select, none {aucune trace} other {{known}}}",
  "import-another-time":
    "Le fichier va du {first_utc_s} au {last_utc_s}, et l’intervention du {from_utc_s} au {until_utc_s}\u00a0: choisissez une autre intervention\u00a0; ou, si l’horloge était décalée (d’environ {off_h, number} h), indiquez les secondes à ajouter",
  "import-other-shift":
    "{file} est déjà dans cette intervention, avec {shift, number} s ajoutées à ses heures\u00a0: retirez-le d’abord, puis versez-le de nouveau",
  "import-file-unreadable":
    "Le fichier est illisible\u00a0: {error}",
  "photo-import-place-unfit":
    "Le lieu dans les données Exif de la photo n’en est pas un\u00a0: {lat_deg}, {lon_deg}",
  "photo-import-no-zone":
    "La photo date du {taken} selon une horloge dont elle n’indique pas le fuseau\u00a0: donnez ses heures d’avance sur UTC, par exemple 2 pour l’heure d’été d’Europe centrale",
  "import-too-deep":
    "Ce n’est pas un fichier de traces\u00a0: ses éléments ont une profondeur de {deepest}",
  "import-has-entities":
    "Le fichier a des entités ou un type de document, dont aucune trace n’a besoin et qui peuvent remplir la mémoire\u00a0: il n’est pas lu",
  "import-disk-full":
    "Il reste {free_mb} sur le disque, dont le journal a besoin de {needed_mb}\u00a0: le fichier n’est pas pris\u00a0; faites d’abord de la place",
  "import-not-kept":
    "Le fichier ne peut pas être conservé\u00a0: {error}",
  "import-damaged":
    "Ce qui a été lu d’un fichier versé est endommagé ({error})\u00a0; versez le fichier de nouveau",
  "import-no-point":
    "aucun point n’a de lieu ni d’heure\u00a0: enregistrez-le à nouveau comme trace, avec les heures",
  "import-no-timed-place": "aucun lieu n’a d’heure\u00a0: enregistrez-le à nouveau comme trace avec les heures",
  "import-track-unplaced": "aucune trace n’a de lieu sur la Terre\u00a0: son site n’est pas localisé",
  "import-nothing-usable": "{damage}\u00a0; {reason}",
  "tables-being-made":
    "Les listes de cette intervention sont en cours de création à partir de son journal, arrivé sans base de données\u00a0; la relecture fonctionne déjà. Réessayez dans une minute.",
  "tables-not-made":
    "Les listes de cette intervention n’ont pas pu être créées à partir de son journal\u00a0: {reason}",
  "projection-ended":
    "le processus qui crée les tables à partir du journal s’est terminé",
};
