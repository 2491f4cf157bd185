/** Refusals about logins, users, tokens and passwords, by their codes, in French. */
import type { Part } from "../catalogue";

export const refusal_access: Part<"refusal_access"> = {
  "foreign-page":
    "Cette demande vient d’une page qui n’est pas celle de la station.",
  "last-administrator":
    "{user} est le seul administrateur\u00a0; nommez-en d’abord un autre",
  "login-first":
    "Connectez-vous d’abord.",
  "login-too-often":
    "Trop d’essais de connexion\u00a0; attendez une minute.",
  "login-wrong":
    "Le nom ou le mot de passe est faux.",
  "not-in-charge":
    "Rien n’a été changé\u00a0: {reason}.",
  "origin-missing":
    "La demande d’un navigateur doit nommer son origine\u00a0; les programmes utilisent un jeton d’API.",
  "password-generated":
    "Changez d’abord votre mot de passe\u00a0: celui-ci a été généré et se trouve dans un fichier.",
  "password-same":
    "Le nouveau mot de passe est l’ancien\u00a0; choisissez-en un autre.",
  "password-too-long":
    "Un mot de passe a au plus {most} caractères",
  "password-too-short":
    "Un mot de passe a au moins {least} caractères",
  "password-wrong":
    "L’ancien mot de passe est faux.",
  "role-too-low":
    "Il faut le rôle {needed, select, viewer {observateur} commander {commandant} other {administrateur}}\u00a0; {user} est {role, select, viewer {observateur} commander {commandant} other {administrateur}}.",
  "role-unknown":
    "Il n’y a pas de rôle {role}\u00a0; les rôles sont {known}",
  "sample-unit-unknown":
    "Il n’y a pas de boîtier enregistré {unit}.",
  "samples-not-taken":
    "Cette station ne prend pas de mesures\u00a0: elle ne fait que relire.",
  "ticket-for-browsers":
    "Un transfert n’existe que pour une connexion par navigateur\u00a0; un jeton est valable là aussi.",
  "ticket-void":
    "Ce transfert de connexion n’est pas ou plus valable\u00a0; connectez-vous.",
  "token-above-own-role":
    "Vous êtes {role, select, viewer {observateur} commander {commandant} other {administrateur}}\u00a0; un de vos jetons ne peut pas être {wanted, select, viewer {observateur} commander {commandant} other {administrateur}}.",
  "token-beyond-own-scope":
    "Un jeton ne crée que des jetons pour ce qui lui est permis.",
  "token-maker-unknown":
    "Il n’y a pas d’utilisateur {user}",
  "token-not-yours":
    "Vous n’avez pas de tel jeton.",
  "token-outlasts":
    "Un jeton n’en crée pas qui dure plus que lui\u00a0; donnez moins de jours.",
  "token-role-too-high":
    "Un jeton peut avoir le rôle de son propriétaire ou un rôle inférieur, pas supérieur",
  "token-scope":
    "Ce jeton est pour {allowed}, et non pour {wanted}.",
  "tokens-too-many":
    "{user} a {most} jetons\u00a0; supprimez-en un qui n’est pas utilisé",
  "unit-token-of-another":
    "Ce jeton est pour les mesures de {unit}, et non de {wanted}.",
  "unit-token-unknown":
    "{unit} n’a pas de tel jeton.",
  "unit-tokens-too-many":
    "{unit} a {most} jetons\u00a0; supprimez-en d’abord un",
  "user-there":
    "Il y a déjà un utilisateur {username}",
  "user-unknown":
    "Il n’y a pas d’utilisateur {username}",
  "username-unfit":
    "Un nom d’utilisateur est une ligne de 1 à 80 caractères simples, sans «\u00a0/\u00a0»",
  "logins-too-many":
    "Trop de personnes se connectent en ce moment\u00a0; réessayez dans quelques secondes.",
};
