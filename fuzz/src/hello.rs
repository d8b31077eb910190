//! The packet with which peers introduce themselves.

use super::mend;
use tamias2d::hello::Hello;

/// The input as a packet, as it is and with its check made right.
pub fn run(data: &[u8]) -> bool {
    let (mut bytes, mut is_read) = (data.to_vec(), false);
    for is_mended in [false, true] {
        if is_mended {
            mend::check_last_word(&mut bytes);
        }
        match Hello::decode(&bytes) {
            Ok(hello) => {
                is_read = true;
                assert_eq!(hello.encode(), bytes, "a packet that is read is written alike");
                assert_eq!(hello.check(&hello), Ok(()));
                let other = Hello { tick: hello.tick ^ 1, ..hello };
                let error = other.check(&hello).expect_err("another tick");
                assert!(!error.to_string().is_empty());
            }
            Err(error) => assert!(!error.to_string().is_empty()),
        }
    }
    is_read
}
