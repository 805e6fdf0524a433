import java.nio.file.*;

/** Prints what docs/Verify.java answers for each N.yaml and N.signers in a folder, N counted from 0: one line each. */
public class Verdicts {
    public static void main(String[] args) throws Exception {
        for (int n = 0; Files.exists(Path.of(args[0], n + ".yaml")); n++) {
            try {
                byte[][] files = {
                    Files.readAllBytes(Path.of(args[0], n + ".yaml")), Files.readAllBytes(Path.of(args[0], n + ".signers"))};
                System.out.println("good: " + Verify.verify(files[0], files[1]));
            } catch (Exception | StackOverflowError refused) {
                System.out.println(refused);
            }
        }
    }
}
