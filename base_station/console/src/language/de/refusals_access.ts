/** Refusals about logins, users, tokens and passwords, by their codes, in German. */
import type { Part } from "../catalogue";

export const refusal_access: Part<"refusal_access"> = {
  "foreign-page":
    "Das kam von einer Seite, die nicht die der Station ist.",
  "last-administrator":
    "{user} ist der einzige Administrator; bestimmen Sie zuerst einen weiteren",
  "login-first":
    "Melden Sie sich zuerst an.",
  "login-too-often":
    "Zu viele Versuche, sich anzumelden; warten Sie eine Minute.",
  "login-wrong":
    "Name oder Passwort ist falsch.",
  "not-in-charge":
    "Es wurde nichts geändert: {reason}.",
  "origin-missing":
    "Die Anfrage eines Browsers muss ihre Herkunft nennen; Programme verwenden ein API-Token.",
  "password-generated":
    "Ändern Sie zuerst Ihr Passwort: Dieses wurde erzeugt und steht in einer Datei.",
  "password-same":
    "Das neue Passwort ist das alte; wählen Sie ein anderes.",
  "password-too-long":
    "Ein Passwort hat höchstens {most} Zeichen",
  "password-too-short":
    "Ein Passwort hat mindestens {least} Zeichen",
  "password-wrong":
    "Das alte Passwort ist falsch.",
  "role-too-low":
    "Dazu ist die Rolle {needed, select, viewer {Beobachter} commander {Einsatzleiter} other {Administrator}} nötig; {user} ist {role, select, viewer {Beobachter} commander {Einsatzleiter} other {Administrator}}.",
  "role-unknown":
    "Eine Rolle {role} gibt es nicht; Rollen sind {known}",
  "sample-unit-unknown":
    "Ein registriertes Gerät {unit} gibt es nicht.",
  "samples-not-taken":
    "Diese Station nimmt keine Messwerte an: Sie gibt nur wieder.",
  "ticket-for-browsers":
    "Eine Übergabe gibt es nur für eine Anmeldung im Browser; ein Token gilt auch dort.",
  "ticket-void":
    "Diese Übergabe der Anmeldung gilt nicht oder nicht mehr; melden Sie sich an.",
  "token-above-own-role":
    "Sie sind {role, select, viewer {Beobachter} commander {Einsatzleiter} other {Administrator}}; ein Token von Ihnen kann nicht {wanted, select, viewer {Beobachter} commander {Einsatzleiter} other {Administrator}} sein.",
  "token-beyond-own-scope":
    "Ein Token erzeugt nur Tokens für das, wofür er selbst gilt.",
  "token-maker-unknown":
    "Einen Benutzer {user} gibt es nicht",
  "token-not-yours":
    "Sie haben keinen solchen Token.",
  "token-outlasts":
    "Ein Token erzeugt keinen, der länger gilt als er selbst; geben Sie weniger Tage an.",
  "token-role-too-high":
    "Ein Token kann die Rolle seines Besitzers oder eine niedrigere haben, keine höhere",
  "token-scope":
    "Dieser Token gilt für {allowed}, nicht für {wanted}.",
  "tokens-too-many":
    "{user} hat {most} Tokens; entfernen Sie einen, der nicht verwendet wird",
  "unit-token-of-another":
    "Dieser Token gilt für Messwerte von {unit}, nicht von {wanted}.",
  "unit-token-unknown":
    "{unit} hat keinen solchen Token.",
  "unit-tokens-too-many":
    "{unit} hat {most} Tokens; entfernen Sie zuerst einen davon",
  "user-there":
    "Einen Benutzer {username} gibt es schon",
  "user-unknown":
    "Einen Benutzer {username} gibt es nicht",
  "username-unfit":
    "Ein Benutzername ist eine Zeile mit 1 bis 80 einfachen Zeichen, ohne „/“",
  "logins-too-many":
    "Im Moment melden sich zu viele an; versuchen Sie es in einigen Sekunden noch einmal.",
};
