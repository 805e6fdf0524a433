import java.nio.ByteBuffer;
import java.nio.file.*;
import java.security.*;
import java.security.spec.X509EncodedKeySpec;
import java.time.Instant;
import java.util.*;
import java.util.regex.*;
import static java.nio.charset.StandardCharsets.UTF_8;

/** Checks text, signature and signer of a passport by verifying.md: java Verify.java PASSPORT ALLOWED_SIGNERS */
public class Verify {
    static final String VISIBLE = " !#-\\[\\]-~\u00A1-\u00AC\u00AE-\u02AF\u0370-\u0373\u0375-\u0377\u037A-\u037D\u037F\u0384-\u0386"
        + "\u0388-\u0482\u048A-\u052F\u2010-\u2027\u2030-\u205E\u20AC\u2103\u2116\u2190-\u22FF\u3001-\u3003\u3005-\u3011"
        + "\u3041-\u3096\u309D-\u30FF\u4E00-\u9FFF\uAC00-\uD7A3\uFF01-\uFF5E", KEY = "[a-z][a-z0-9_]*";
    static final HexFormat HEX = HexFormat.of();
    static final Pattern SCALAR =
        Pattern.compile("\"(?:[" + VISIBLE + "]++|\\\\[\"\\\\])*+\"|true|false|-?[0-9]++(?:\\.[0-9]++(?:e[+-][0-9]{2,3})?)?");
    static final Pattern FLOW = Pattern.compile("\\[1(?:, 1)*+\\]|\\{(?:K: 1(?:, K: 1)*+)?\\}".replace("K", KEY));
    static final Pattern LINE = Pattern.compile("|#[ -~]*+|(?:  )*+(?:- (?:K: )?1|K:(?: 1)?)".replace("K", KEY));
    static final Pattern SIGNER = Pattern.compile("(\"[^\"]*\"|[^\\s\"#][^\\s\"]*)[ \t]+(?:((?:[^\\s\"]|\"[^\"]*\")+)[ \t]+)?"
        + "(sk-ssh-ed25519@openssh\\.com|ssh-ed25519)[ \t]+([A-Za-z0-9+/=]+)(?:[ \t].*)?");
    static final Pattern OPTION = Pattern.compile("(namespaces|valid-after|valid-before)=\"([^\"]*)\"(?:,|$)");
    static final Pattern PASSPORT = Pattern.compile("format: \"dtg-passport/1\"\npassport:\n(?:  .*\n)*?"
        + "  issued_at: \"(.*)\"\n  issuer: \"(.*)\"\n"); // without comments and empty lines

    public static void main(String[] args) throws Exception {
        System.out.println("good: " + verify(Files.readAllBytes(Path.of(args[0])), Files.readAllBytes(Path.of(args[1]))));
    }

    /** Returns who signed. Any exception is a refusal. */
    static String verify(byte[] file, byte[] signers) throws Exception {
        String text = UTF_8.newDecoder().decode(ByteBuffer.wrap(file)).toString();
        int end = text.indexOf("\nsignature: |\n") + 1;
        require(file.length <= 1 << 20 && end > 0, "no signed text");
        String signed = text.substring(0, end), armor = text.substring(end + "signature: |\n".length());
        for (String line : signed.split("\n")) {
            String rest = line.startsWith("#") ? line : SCALAR.matcher(line).replaceAll("1"), before = "";
            while (!rest.equals(before) && !rest.startsWith("#")) rest = FLOW.matcher(before = rest).replaceAll("1");
            require(LINE.matcher(rest).matches(), "not the form of a signed text: " + line);
        }
        byte[] decoded = Base64.getMimeDecoder().decode(armor.replaceAll("-----.*", ""));
        String base64 = Base64.getEncoder().encodeToString(decoded).replaceAll(".{1,70}", "  $0\n");
        require(armor.equals("  -----BEGIN SSH SIGNATURE-----\n" + base64 + "  -----END SSH SIGNATURE-----\n"), "armor");
        String block = HEX.formatHex(decoded), domain = sized(hex("dtg-passport")) + sized("") + sized(hex("sha512"));
        for (String line : new String(signers, UTF_8).lines().toList()) {
            Matcher signer = SIGNER.matcher(line.strip());
            if (!signer.matches()) continue;
            String type = sized(hex(signer.group(3))), key = HEX.formatHex(Base64.getDecoder().decode(signer.group(4)));
            boolean token = signer.group(3).startsWith("sk-");
            // The key determines the block except for the numbers at its end. The version, 1, is not signed.
            String head = hex("SSHSIG") + "00000001" + sized(key) + domain
                + String.format("%08x%s00000040", type.length() / 2 + 4 + 64 + (token ? 5 : 0), type);
            if (!block.startsWith(head) || block.length() != head.length() + (token ? 2 * 69 : 2 * 64)) continue;
            String point = key.substring(type.length() + 8, type.length() + 8 + 64), numbers = block.substring(head.length());
            String message = hex("SSHSIG") + domain + sized(digest("SHA-512", hex(signed)));
            if (token) message = digest("SHA-256", key.substring(type.length() + 8 + 64 + 8)) // of the application
                + numbers.substring(128) + digest("SHA-256", message); // flags and counter, PROTOCOL.u2f
            byte[] der = HEX.parseHex("302a300506032b6570032100" + point);
            Signature ed25519 = Signature.getInstance("Ed25519"); // RFC 8032; S is below the order
            ed25519.initVerify(KeyFactory.getInstance("Ed25519").generatePublic(new X509EncodedKeySpec(der)));
            ed25519.update(HEX.parseHex(message));
            require(ed25519.verify(HEX.parseHex(numbers.substring(0, 128))), "altered");
            Matcher passport = PASSPORT.matcher(signed.replaceAll("(?m)^#.*\n|^\n", ""));
            require(passport.lookingAt(), "not a passport");
            if (matches(signer.group(1).replace("\"", ""), passport.group(2))
                && allows(signer.group(2), Instant.parse(passport.group(1)))) return passport.group(2);
        }
        throw new SignatureException("not signed by a key of its issuer at its time of issue");
    }

    static boolean allows(String options, Instant at) throws SignatureException {
        require(options == null || OPTION.matcher(options).replaceAll("").isEmpty(), "an option that is not supported: " + options);
        return options == null || OPTION.matcher(options).results().allMatch(option -> switch (option.group(1)) {
            case "namespaces" -> matches(option.group(2), "dtg-passport");
            case "valid-after" -> !at.isBefore(time(option.group(2)));
            default -> !at.isAfter(time(option.group(2)));
        });
    }

    static Instant time(String text) { // YYYYMMDD[HHMM[SS]]Z
        String digits = text.matches("([0-9]{8}|[0-9]{12}|[0-9]{14})Z") ? text.replace("Z", "000000").substring(0, 14) : "";
        return Instant.parse(digits.replaceFirst("(....)(..)(..)(..)(..)(..)", "$1-$2-$3T$4:$5:$6Z"));
    }

    static boolean matches(String patterns, String name) {
        boolean found = false;
        for (String pattern : patterns.replaceAll("[^*?,!]+", "\\\\Q$0\\\\E").replace("*", ".*").replace("?", ".").split(","))
            if (name.matches(pattern.replaceFirst("^!", ""))) if (pattern.startsWith("!")) return false; else found = true;
        return found;
    }

    static String hex(String text) { return HEX.formatHex(text.getBytes(UTF_8)); }
    static String sized(String hex) { return String.format("%08x%s", hex.length() / 2, hex); }
    static String digest(String algorithm, String hex) throws NoSuchAlgorithmException {
        return HEX.formatHex(MessageDigest.getInstance(algorithm).digest(HEX.parseHex(hex)));
    }
    static void require(boolean holds, String why) throws SignatureException { if (!holds) throw new SignatureException(why); }
}
