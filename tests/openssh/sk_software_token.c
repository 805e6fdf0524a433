/*
 * A security key in software, for tests alone: the private half of a key is its own key handle, and nobody is asked for
 * a touch. Never enroll a key with it that anybody trusts.
 *
 * It offers OpenSSH's interface for security key providers (OpenSSH's PROTOCOL.u2f and sk-api.h, version 0x000a0000, as
 * ssh-sk-helper of OpenSSH 9.2 loads it) for Ed25519:
 *
 *     gcc -shared -fPIC -o sk_software_token.so sk_software_token.c -lcrypto
 *     SSH_SK_PROVIDER=$PWD/sk_software_token.so ssh-keygen -t ed25519-sk
 */
#include <openssl/evp.h>
#include <openssl/rand.h>
#include <openssl/sha.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define API_VERSION 0x000a0000u
#define ALGORITHM_ED25519 1u
#define USER_PRESENT 0x01u
#define ERROR_GENERAL -1
#define ERROR_UNSUPPORTED -2
#define SEED_LENGTH 32u
#define PUBLIC_KEY_LENGTH 32u
#define SIGNATURE_LENGTH 64u
/* What is signed: SHA-256 of the application, flags, counter, SHA-256 of the message. */
#define SIGNED_LENGTH (SHA256_DIGEST_LENGTH + 1 + 4 + SHA256_DIGEST_LENGTH)

struct sk_option;
struct sk_resident_key;

struct sk_enroll_response {
	uint8_t flags;
	uint8_t *public_key;
	size_t public_key_len;
	uint8_t *key_handle;
	size_t key_handle_len;
	uint8_t *signature;
	size_t signature_len;
	uint8_t *attestation_cert;
	size_t attestation_cert_len;
	uint8_t *authdata;
	size_t authdata_len;
};

struct sk_sign_response {
	uint8_t flags;
	uint32_t counter;
	uint8_t *sig_r;
	size_t sig_r_len;
	uint8_t *sig_s;
	size_t sig_s_len;
};

uint32_t sk_api_version(void);
int sk_enroll(uint32_t algorithm, const uint8_t *challenge, size_t challenge_length, const char *application,
    uint8_t flags, const char *pin, struct sk_option **options, struct sk_enroll_response **response);
int sk_sign(uint32_t algorithm, const uint8_t *message, size_t message_length, const char *application,
    const uint8_t *key_handle, size_t key_handle_length, uint8_t flags, const char *pin, struct sk_option **options,
    struct sk_sign_response **response);
int sk_load_resident_keys(const char *pin, struct sk_option **options, struct sk_resident_key ***keys, size_t *count);

uint32_t
sk_api_version(void)
{
	return API_VERSION;
}

/* A new key: 0, or -1 with nothing allocated that the response does not hold. */
static int
fill_enrolled(struct sk_enroll_response *enrolled)
{
	EVP_PKEY *key = NULL;
	size_t length = PUBLIC_KEY_LENGTH;
	int result = -1;

	enrolled->key_handle = calloc(1, SEED_LENGTH);
	enrolled->public_key = calloc(1, PUBLIC_KEY_LENGTH);
	/* No attestation: an empty signature that is there. */
	enrolled->signature = calloc(1, 1);
	if (enrolled->key_handle == NULL || enrolled->public_key == NULL || enrolled->signature == NULL)
		return -1;
	if (RAND_bytes(enrolled->key_handle, SEED_LENGTH) == 1 &&
	    (key = EVP_PKEY_new_raw_private_key(EVP_PKEY_ED25519, NULL, enrolled->key_handle, SEED_LENGTH)) != NULL &&
	    EVP_PKEY_get_raw_public_key(key, enrolled->public_key, &length) == 1 && length == PUBLIC_KEY_LENGTH) {
		enrolled->key_handle_len = SEED_LENGTH;
		enrolled->public_key_len = PUBLIC_KEY_LENGTH;
		result = 0;
	}
	EVP_PKEY_free(key);
	return result;
}

int
sk_enroll(uint32_t algorithm, const uint8_t *challenge, size_t challenge_length, const char *application,
    uint8_t flags, const char *pin, struct sk_option **options, struct sk_enroll_response **response)
{
	struct sk_enroll_response *enrolled;

	(void)challenge, (void)challenge_length, (void)application, (void)pin, (void)options;
	if (algorithm != ALGORITHM_ED25519)
		return ERROR_UNSUPPORTED;
	if ((enrolled = calloc(1, sizeof(*enrolled))) == NULL)
		return ERROR_GENERAL;
	enrolled->flags = flags;
	if (fill_enrolled(enrolled) != 0) {
		free(enrolled->key_handle);
		free(enrolled->public_key);
		free(enrolled->signature);
		free(enrolled);
		return ERROR_GENERAL;
	}
	*response = enrolled;
	return 0;
}

static int
sign_ed25519(const uint8_t *seed, const uint8_t *bytes, size_t length, uint8_t *signature)
{
	EVP_PKEY *key = EVP_PKEY_new_raw_private_key(EVP_PKEY_ED25519, NULL, seed, SEED_LENGTH);
	EVP_MD_CTX *context = EVP_MD_CTX_new();
	size_t signature_length = SIGNATURE_LENGTH;
	int good = key != NULL && context != NULL && EVP_DigestSignInit(context, NULL, NULL, NULL, key) == 1 &&
	    EVP_DigestSign(context, signature, &signature_length, bytes, length) == 1 &&
	    signature_length == SIGNATURE_LENGTH;

	EVP_MD_CTX_free(context);
	EVP_PKEY_free(key);
	return good ? 0 : -1;
}

int
sk_sign(uint32_t algorithm, const uint8_t *message, size_t message_length, const char *application,
    const uint8_t *key_handle, size_t key_handle_length, uint8_t flags, const char *pin, struct sk_option **options,
    struct sk_sign_response **response)
{
	static uint32_t counter;
	struct sk_sign_response *signed_response;
	uint8_t bytes[SIGNED_LENGTH], *at = bytes;
	int shift;

	(void)flags, (void)pin, (void)options;
	if (algorithm != ALGORITHM_ED25519)
		return ERROR_UNSUPPORTED;
	if (key_handle_length != SEED_LENGTH || (signed_response = calloc(1, sizeof(*signed_response))) == NULL)
		return ERROR_GENERAL;
	signed_response->flags = USER_PRESENT;
	signed_response->counter = ++counter;
	SHA256((const unsigned char *)application, strlen(application), at);
	at += SHA256_DIGEST_LENGTH;
	*at++ = signed_response->flags;
	for (shift = 24; shift >= 0; shift -= 8)
		*at++ = (uint8_t)(signed_response->counter >> shift);
	SHA256(message, message_length, at);
	signed_response->sig_r_len = SIGNATURE_LENGTH;
	signed_response->sig_r = calloc(1, SIGNATURE_LENGTH);
	if (signed_response->sig_r == NULL || sign_ed25519(key_handle, bytes, sizeof(bytes), signed_response->sig_r) != 0) {
		free(signed_response->sig_r);
		free(signed_response);
		return ERROR_GENERAL;
	}
	*response = signed_response;
	return 0;
}

/* No key resides in this token: each is in its own handle. */
int
sk_load_resident_keys(const char *pin, struct sk_option **options, struct sk_resident_key ***keys, size_t *count)
{
	(void)pin, (void)options, (void)keys, (void)count;
	return ERROR_UNSUPPORTED;
}
